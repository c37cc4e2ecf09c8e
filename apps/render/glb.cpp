#include "render/glb.hpp"

#include <tiny_gltf.h>

#include <cstring>
#include <limits>
#include <sstream>

#include "crumble/base/error.hpp"

namespace crumble::render {
namespace {

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

int add_vectors(tinygltf::Model& model, const std::vector<Vec3>& values) {
  std::vector<float> numbers;
  for (const Vec3& v : values) {
    for (int k = 0; k < 3; ++k) numbers.push_back(static_cast<float>(v[k]));
  }
  return add_accessor(model, numbers.data(), numbers.size() * sizeof(float), values.size(), TINYGLTF_TYPE_VEC3,
                      TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
}

// glTF wants the bounds of positions, as the float32 numbers of the file.
void add_bounds(tinygltf::Accessor& accessor, const std::vector<Vec3>& values) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec3 lower = Vec3::Constant(kFar), upper = Vec3::Constant(-kFar);
  for (const Vec3& v : values) {
    const Vec3 narrow = v.cast<float>().cast<double>();
    lower = lower.cwiseMin(narrow), upper = upper.cwiseMax(narrow);
  }
  accessor.minValues = {lower.x(), lower.y(), lower.z()};
  accessor.maxValues = {upper.x(), upper.y(), upper.z()};
}

}  // namespace

std::string to_glb(const TriangleMesh& mesh, const SurfaceAttributes& attributes) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "crumble";
  model.buffers.emplace_back();
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] = add_vectors(model, mesh.vertices);
  add_bounds(model.accessors[0], mesh.vertices);
  if (!attributes.normals.empty()) primitive.attributes["NORMAL"] = add_vectors(model, attributes.normals);
  if (!attributes.colours.empty()) primitive.attributes["COLOR_0"] = add_vectors(model, attributes.colours);
  primitive.indices =
      add_accessor(model, mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle), 3 * mesh.triangles.size(),
                   TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  model.meshes.emplace_back().primitives = {primitive};
  model.nodes.emplace_back().mesh = 0;
  model.scenes.emplace_back().nodes = {0};
  model.defaultScene = 0;
  std::ostringstream out;
  if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true)) {
    throw Error(Code::internal, "tinygltf cannot write the surface");
  }
  return out.str();
}

}  // namespace crumble::render
