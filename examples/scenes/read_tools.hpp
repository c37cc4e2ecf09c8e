// The parts of a scene that tell of tools, of attachments and of how they move.
#pragma once

#include <filesystem>

#include "crumble/base/memory.hpp"
#include "scenes/fields.hpp"
#include "scenes/scene.hpp"

namespace crumble {

/// `tool` with `start` and `motion` beside it, or `tools` with their own within: to scene.def.tools and scene.motions.
/// Needs the scene's mesh and top. `folder` is that of the scene's file, empty for a built-in one.
void read_tools(Fields& scene_fields, const std::filesystem::path& folder, Scene& scene);
/// `attachments`, after the tools.
void read_attachments(Fields& scene_fields, Scene& scene);

Friction read_friction(Fields fields);
/// A box, a half-space or a list, as nodes of `mesh`, ascending.
Vector<std::uint32_t> read_region(Fields fields, const TetMesh& mesh);

}  // namespace crumble
