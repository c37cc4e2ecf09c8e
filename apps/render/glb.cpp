// Binary glTF 2.0 through tinygltf: a node and mesh for each fragment, in it a primitive for each material. Both
// primitives share the fragment's vertices. glTF hangs normals on vertices, so a vertex stands there once for each
// normal that its corners have: on the skin's creases and round the cracks. Welded by place, a fragment is closed.
#include <tiny_gltf.h>

#include <cstring>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "render/mesh_formats.hpp"

namespace crumble::render {
namespace {

using Indices = Vector<std::uint32_t>;

// The number of an accessor of `count` things of `type` in the model's one buffer; they have `size` bytes in all.
int add_accessor(tinygltf::Model& model, const void* data, std::size_t size, std::size_t count, int type,
                 int component_type, int target) {
  std::vector<unsigned char>& bytes = model.buffers[0].data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes.size();
  view.byteLength = size;
  view.target = target;
  bytes.resize(bytes.size() + size);
  std::memcpy(bytes.data() + view.byteOffset, data, size);
  model.bufferViews.push_back(view);
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
  accessor.componentType = component_type;
  accessor.count = count;
  accessor.type = type;
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size()) - 1;
}

int add_vectors(tinygltf::Model& model, const Vector<Eigen::Vector3f>& values) {
  return add_accessor(model, values.data(), values.size() * sizeof(Eigen::Vector3f), values.size(), TINYGLTF_TYPE_VEC3,
                      TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
}

// glTF wants the bounds of positions, as the float32 numbers of the file.
void add_bounds(tinygltf::Accessor& accessor, const Vector<Eigen::Vector3f>& values) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Eigen::Vector3f lower = Eigen::Vector3f::Constant(kFar), upper = -lower;
  for (const Eigen::Vector3f& v : values) lower = lower.cwiseMin(v), upper = upper.cwiseMax(v);
  accessor.minValues = {lower.x(), lower.y(), lower.z()};
  accessor.maxValues = {upper.x(), upper.y(), upper.z()};
}

// The vertices of one fragment: each pair of a surface's vertex and a normal that is in use, in ascending order.
class Vertices {
 public:
  Vertices(const Surface& surface, const Indices& triangles) : mesh_(surface.mesh) {
    for (const std::uint32_t t : triangles) {
      for (std::size_t k = 0; k < 3; ++k) numbers_.emplace(key(t, k), 0);
    }
    std::uint32_t next = 0;
    for (auto& [key, number] : numbers_) number = next++;
  }
  std::uint32_t number(std::uint32_t triangle, std::size_t corner) const { return numbers_.at(key(triangle, corner)); }
  Vector<Eigen::Vector3f> pick(const Vector<Vec3>& values) const {
    Vector<Eigen::Vector3f> picked;
    for (const auto& [key, number] : numbers_) picked.push_back(values[key.first].cast<float>());
    return picked;
  }
  Vector<Eigen::Vector3f> normals() const {
    Vector<Eigen::Vector3f> picked;
    for (const auto& [key, number] : numbers_) picked.emplace_back(key.second.data());
    return picked;
  }

 private:
  using Key = std::pair<std::uint32_t, std::array<float, 3>>;
  Key key(std::uint32_t triangle, std::size_t corner) const {
    const std::uint32_t vertex = mesh_.triangles[triangle][corner];
    if (mesh_.corner_normals.empty()) return {vertex, {}};
    Eigen::Vector3f n = mesh_.corner_normals[triangle][corner];
    if (n.isZero(0)) n = Eigen::Vector3f::UnitZ();  // of a facet without area; glTF wants units
    return {vertex, {n.x(), n.y(), n.z()}};
  }

  const RenderMesh& mesh_;
  std::map<Key, std::uint32_t> numbers_;
};

// The triangles of one material, with the attributes that they share with the other one.
void add_primitive(tinygltf::Model& model, const Surface& surface, const Vertices& vertices, const Indices& triangles,
                   tinygltf::Primitive primitive, std::vector<tinygltf::Primitive>& primitives) {
  if (triangles.empty()) return;
  Indices corners;
  for (const std::uint32_t t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) corners.push_back(vertices.number(t, k));
  }
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.indices =
      add_accessor(model, corners.data(), corners.size() * sizeof(std::uint32_t), corners.size(), TINYGLTF_TYPE_SCALAR,
                   TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  if (!surface.mesh.materials.empty()) primitive.material = static_cast<int>(surface.mesh.materials[triangles[0]]);
  primitives.push_back(primitive);
}

tinygltf::Mesh make_mesh(tinygltf::Model& model, const Surface& surface, const Indices& triangles) {
  const Vertices vertices(surface, triangles);
  tinygltf::Primitive primitive;
  const int positions = add_vectors(model, vertices.pick(surface.mesh.positions));
  add_bounds(model.accessors[static_cast<std::size_t>(positions)], vertices.pick(surface.mesh.positions));
  primitive.attributes["POSITION"] = positions;
  if (!surface.mesh.corner_normals.empty()) primitive.attributes["NORMAL"] = add_vectors(model, vertices.normals());
  if (!surface.colours.empty()) primitive.attributes["COLOR_0"] = add_vectors(model, vertices.pick(surface.colours));
  if (!surface.mesh.rest_positions.empty()) {
    primitive.attributes["_REST"] = add_vectors(model, vertices.pick(surface.mesh.rest_positions));
  }
  std::array<Indices, 2> by_material;
  for (const std::uint32_t t : triangles) {
    const bool is_skin = surface.mesh.materials.empty() || surface.mesh.materials[t] == Material::skin;
    by_material[is_skin ? 0 : 1].push_back(t);
  }
  tinygltf::Mesh mesh;
  for (const Indices& some : by_material) add_primitive(model, surface, vertices, some, primitive, mesh.primitives);
  return mesh;
}

void add_materials(tinygltf::Model& model) {
  for (const MaterialLook& look : kMaterialLooks) {
    tinygltf::Material& material = model.materials.emplace_back();
    material.name = look.name;
    material.pbrMetallicRoughness.baseColorFactor = {look.colour.x(), look.colour.y(), look.colour.z(), 1};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.7;
  }
}

}  // namespace

std::string to_glb(const Surface& surface) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "crumble";
  model.buffers.emplace_back();
  tinygltf::Scene& scene = model.scenes.emplace_back();
  if (!surface.mesh.materials.empty()) add_materials(model);
  for (const auto& [fragment, triangles] : triangles_by_fragment(surface)) {
    tinygltf::Node node;
    node.mesh = static_cast<int>(model.meshes.size());
    model.meshes.push_back(make_mesh(model, surface, triangles));
    if (!surface.fragments.empty()) {
      node.name = model.meshes.back().name = "fragment_" + std::to_string(fragment);
      node.extras = tinygltf::Value({{"fragment", tinygltf::Value(static_cast<int>(fragment))}});
    }
    scene.nodes.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(node);
  }
  model.defaultScene = 0;
  std::ostringstream out;
  if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true)) {
    throw Error(Code::internal, "tinygltf cannot write the surface");
  }
  return out.str();
}

}  // namespace crumble::render
