// What the files say of a broken body: fragments, materials, normals at edges, places at rest.
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <assimp/Importer.hpp>
#include <cstring>
#include <set>

#include "crumble/base/error.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/convex.hpp"
#include "render/mesh_file.hpp"
#include "render/temporary_folder.hpp"
#include "support/mesh_files.hpp"

namespace crumble::render {
namespace {

constexpr double kVolume = 0.011 * 0.02 * 0.03;  // of each half
constexpr std::array<std::uint32_t, 2> kIds{0, 7};

Eigen::Vector3f facet_normal(const RenderMesh& mesh, const Triangle& t) {
  const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
  return (b - a).cross(c - a).normalized().cast<float>();
}

// A bar broken in two across, the halves still in touch: fragments 0 and 7, the broken faces interior, flat normals.
// At rest it stood 10 mm to the left. The fragments' triangles take turns, as those of a real surface may.
Surface broken_bar() {
  const TriangleMesh half = make_bar({0.011, 0.02, 0.03}).surface;
  Surface surface;
  RenderMesh& mesh = surface.mesh;
  for (const double side : {-0.0055, 0.0055}) {
    for (const Vec3& p : half.vertices) mesh.positions.push_back(p + Vec3(side, 0.01, 0));
  }
  for (const auto& [a, b, c] : half.triangles) {
    for (std::uint32_t side = 0; side < 2; ++side) {
      const auto first = static_cast<std::uint32_t>(side * half.vertices.size());
      const Triangle triangle{first + a, first + b, first + c};
      const Eigen::Vector3f normal = facet_normal(mesh, triangle);
      mesh.corner_normals.push_back({normal, normal, normal});
      const bool is_broken = side == 0 ? normal.x() > 0.9f : normal.x() < -0.9f;
      mesh.materials.push_back(is_broken ? Material::interior : Material::skin);
      surface.fragments.push_back(kIds[side]);
      surface.tetrahedra.push_back(static_cast<std::uint32_t>(100 + mesh.triangles.size()));
      mesh.triangles.push_back(triangle);
    }
  }
  for (const Vec3& p : mesh.positions) mesh.rest_positions.push_back(p - Vec3(0.01, 0, 0));
  surface.time = 1.5;
  return surface;
}

Vector<double> numbers(const auto& values) {
  Vector<double> out;
  for (const auto value : values) out.push_back(static_cast<double>(value));
  return out;
}

void expect_closed_halves(const TriangleMesh& mesh, const Vector<double>& fragments) {
  for (const double id : kIds) {
    const TriangleMesh half = select(mesh, fragments, id);
    EXPECT_EQ(half.triangles.size(), 12u);
    EXPECT_EQ(find_surface_defects(half).total(), 0u);
    EXPECT_NEAR(volume(half), kVolume, 1e-6 * kVolume);
  }
}

TEST(BrokenSurfaceFile, PlyHoldsAPropertyForEachColumn) {
  const TemporaryFolder folder;
  const Surface surface = broken_bar();
  write_mesh_file(surface, folder.file("a.ply"));
  const PlyFile back = read_ply(folder.file("a.ply"));
  EXPECT_EQ(back.mesh.triangles, surface.mesh.triangles);
  EXPECT_EQ(back.face.at("fragment"), numbers(surface.fragments));
  EXPECT_EQ(back.face.at("material"), numbers(surface.mesh.materials));
  expect_closed_halves(back.mesh, back.face.at("fragment"));
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(back.vertex.at("rest_x")[i], static_cast<float>(surface.mesh.rest_positions[i].x()));
    EXPECT_EQ(back.vertex.at("rest_z")[i], static_cast<float>(surface.mesh.rest_positions[i].z()));
  }
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(folder.file("a.ply").string(), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mMeshes[0]->mNumFaces, 24u) << "another reader skips what it does not know";
  for (unsigned t = 0; t < 24; ++t) EXPECT_EQ(scene->mMeshes[0]->mFaces[t].mIndices[2], surface.mesh.triangles[t][2]);
}

TEST(BrokenSurfaceFile, VtuHoldsAnArrayForEachColumn) {
  const TemporaryFolder folder;
  const Surface surface = broken_bar();
  write_mesh_file(surface, folder.file("a.vtu"));
  const VtuFile back = read_vtu(folder.file("a.vtu"));
  EXPECT_EQ(back.time, 1.5);
  EXPECT_EQ(back.points, surface.mesh.positions);
  EXPECT_EQ(back.mesh().triangles, surface.mesh.triangles);
  EXPECT_EQ(back.cell_data.at("fragment"), numbers(surface.fragments));
  EXPECT_EQ(back.cell_data.at("material"), numbers(surface.mesh.materials));
  EXPECT_EQ(back.cell_data.at("tetrahedron"), numbers(surface.tetrahedra));
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(Vec3(&back.point_data.at("rest").at(3 * i)), surface.mesh.rest_positions[i]);
  }
  expect_closed_halves(back.mesh(), back.cell_data.at("fragment"));
}

TEST(BrokenSurfaceFile, ObjHasAnObjectForEachFragmentAndItsMaterialsBesideIt) {
  const TemporaryFolder folder;
  const Surface surface = broken_bar();
  write_mesh_file(surface, folder.file("a.obj"));
  EXPECT_EQ(folder.size(), 2u);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(folder.file("a.obj").string(), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 4u) << "two objects of two materials";
  std::multiset<std::string> seen;
  std::map<std::string, TriangleMesh> fragments;
  Vector<std::pair<std::string, const aiMesh*>> meshes;
  for (unsigned i = 0; i < scene->mRootNode->mNumChildren; ++i) {
    const aiNode& node = *scene->mRootNode->mChildren[i];
    for (unsigned k = 0; k < node.mNumMeshes; ++k)
      meshes.emplace_back(node.mName.C_Str(), scene->mMeshes[node.mMeshes[k]]);
  }
  for (const auto& [name, pointer] : meshes) {
    const aiMesh& mesh = *pointer;
    const std::string material = scene->mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
    seen.insert(name + " " + material + " " + std::to_string(mesh.mNumFaces));
    ASSERT_TRUE(mesh.HasNormals() && mesh.HasTextureCoords(0));
    EXPECT_EQ(mesh.mNumUVComponents[0], 3u);
    TriangleMesh& whole = fragments[name];
    for (unsigned t = 0; t < mesh.mNumFaces; ++t) {
      RenderMesh corners;
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned i = mesh.mFaces[t].mIndices[k];
        const aiVector3D &p = mesh.mVertices[i], &rest = mesh.mTextureCoords[0][i];
        EXPECT_NEAR(p.x - rest.x, 0.01, 1e-8);
        EXPECT_EQ(p.z, rest.z);
        corners.positions.push_back({p.x, p.y, p.z});
        whole.vertices.push_back({p.x, p.y, p.z});
      }
      const aiVector3D& n = mesh.mNormals[mesh.mFaces[t].mIndices[0]];
      EXPECT_LT((facet_normal(corners, {0, 1, 2}) - Eigen::Vector3f(n.x, n.y, n.z)).norm(), 1e-5f);
      const auto last = static_cast<std::uint32_t>(whole.vertices.size());
      whole.triangles.push_back({last - 3, last - 2, last - 1});
    }
  }
  EXPECT_EQ(seen, (std::multiset<std::string>{"fragment_0 interior 2", "fragment_0 skin 10", "fragment_7 interior 2",
                                              "fragment_7 skin 10"}));
  for (const auto& [name, mesh] : fragments) {
    EXPECT_EQ(find_surface_defects(weld(mesh)).total(), 0u) << name;
    EXPECT_NEAR(volume(mesh), kVolume, 1e-6 * kVolume) << name;
  }
}

template <class T>
Vector<T> read_accessor(const tinygltf::Model& model, int number) {
  const tinygltf::Accessor& accessor = model.accessors.at(static_cast<std::size_t>(number));
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
  Vector<T> values(accessor.count);
  std::memcpy(static_cast<void*>(values.data()), model.buffers.at(0).data.data() + view.byteOffset,
              accessor.count * sizeof(T));
  return values;
}

TriangleMesh read_primitives(const tinygltf::Model& model, const tinygltf::Mesh& mesh, const Eigen::Vector3f& middle) {
  TriangleMesh out;
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
    const auto positions = read_accessor<Eigen::Vector3f>(model, primitive.attributes.at("POSITION"));
    const auto normals = read_accessor<Eigen::Vector3f>(model, primitive.attributes.at("NORMAL"));
    const auto rest = read_accessor<Eigen::Vector3f>(model, primitive.attributes.at("_REST"));
    EXPECT_EQ(positions.size(), 24u) << "eight corners with three normals each";
    const auto corners = read_accessor<std::uint32_t>(model, primitive.indices);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t v = corners[i];
      if (i % 3 == 0) out.triangles.emplace_back();
      out.triangles.back()[i % 3] = static_cast<std::uint32_t>(out.vertices.size());
      out.vertices.push_back(positions.at(v).cast<double>());
      EXPECT_LT((positions.at(v) - rest.at(v) - Eigen::Vector3f(0.01f, 0, 0)).norm(), 1e-8f);
      EXPECT_NEAR(normals.at(v).norm(), 1, 1e-6);
      EXPECT_GT(normals.at(v).dot(positions.at(v) - middle), 0) << "outward";
    }
  }
  return out;
}

TEST(BrokenSurfaceFile, GlbHasANodeForEachFragmentAndAPrimitiveForEachMaterial) {
  const TemporaryFolder folder;
  write_mesh_file(broken_bar(), folder.file("a.glb"));
  tinygltf::Model model;
  std::string error, warning;
  ASSERT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, folder.file("a.glb").string()))
      << error;
  EXPECT_EQ(error + warning, "");
  ASSERT_EQ(model.nodes.size(), 2u);
  ASSERT_EQ(model.scenes.at(0).nodes.size(), 2u);
  for (std::size_t half = 0; half < 2; ++half) {
    const tinygltf::Node& node = model.nodes[half];
    EXPECT_EQ(node.name, "fragment_" + std::to_string(kIds[half]));
    EXPECT_EQ(node.extras.Get("fragment").GetNumberAsInt(), static_cast<int>(kIds[half]));
    const tinygltf::Mesh& mesh = model.meshes.at(static_cast<std::size_t>(node.mesh));
    ASSERT_EQ(mesh.primitives.size(), 2u);
    for (std::size_t m = 0; m < 2; ++m) {
      EXPECT_EQ(model.materials.at(static_cast<std::size_t>(mesh.primitives[m].material)).name,
                m == 0 ? "skin" : "interior");
      EXPECT_EQ(model.accessors.at(static_cast<std::size_t>(mesh.primitives[m].indices)).count, m == 0 ? 30u : 6u);
    }
    const TriangleMesh whole = read_primitives(model, mesh, {half == 0 ? -0.0055f : 0.0055f, 0.01f, 0});
    EXPECT_EQ(find_surface_defects(weld(whole)).total(), 0u);
    EXPECT_NEAR(volume(whole), kVolume, 1e-6 * kVolume);
  }
}

Code code_of(const Surface& surface, const std::filesystem::path& path) {
  try {
    write_mesh_file(surface, path);
  } catch (const Error& error) {
    return error.code();
  }
  return Code::internal;
}

TEST(BrokenSurfaceFile, IsRefusedWithNothingWritten) {
  const TemporaryFolder folder;
  const auto path = folder.file("a.vtu");
  Surface surface = broken_bar();
  surface.fragments.pop_back();
  EXPECT_EQ(code_of(surface, path), Code::mesh);
  surface = broken_bar();
  surface.mesh.materials[3] = Material::wood;
  EXPECT_EQ(code_of(surface, path), Code::mesh);
  surface = broken_bar();
  surface.mesh.corner_normals[4][1].x() = NAN;
  EXPECT_EQ(code_of(surface, path), Code::invalid_value);
  surface = broken_bar();
  surface.mesh.rest_positions[15].y() = INFINITY;
  EXPECT_EQ(code_of(surface, path), Code::invalid_value);
  EXPECT_EQ(folder.size(), 0u);
  // one of two files cannot be written: then there is none
  std::filesystem::create_directory(folder.file("b.obj"));
  EXPECT_EQ(code_of(broken_bar(), folder.file("b.obj")), Code::io);
  EXPECT_EQ(folder.size(), 1u);
}

}  // namespace
}  // namespace crumble::render
