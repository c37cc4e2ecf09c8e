// The formats of mesh_file.hpp: one source file each. The surface is checked by the caller.
#pragma once

#include <string>

#include "crumble/base/memory.hpp"
#include "render/mesh_file.hpp"

namespace crumble::render {

std::string to_glb(const Surface& surface);
/// `materials`: name of the .mtl file; empty: none, and no triangle names one.
std::string to_obj(const Surface& surface, const std::string& materials);
std::string to_mtl();
std::string to_ply(const Surface& surface);
std::string to_stl(const Surface& surface);
/// Triangles; see vtk_xml.hpp.
std::string to_vtu(const Surface& surface);

struct MaterialLook {
  const char* name;
  Vec3 colour;  // linear red, green, blue
};
/// Skin and interior as other programs shall show them; about the colours of our own renderer.
inline const MaterialLook kMaterialLooks[] = {{"skin", {0.72, 0.66, 0.53}}, {"interior", {0.84, 0.70, 0.45}}};

/// Triangles of each fragment in their order, fragments ascending; one group 0 when the surface knows no fragments.
Vector<std::pair<std::uint32_t, Vector<std::uint32_t>>> triangles_by_fragment(const Surface& surface);

}  // namespace crumble::render
