// `crumble patterns`: a drawing of every class of cut tetrahedra, for the documents.
//
// The tetrahedron lies with node 0 towards the eye, so that all six springs are in sight, and is swollen about its
// middle: parts keep the size they have at rest, so cracks gape.
#include <array>
#include <bit>
#include <cmath>

#include "commands.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/transcendental.hpp"
#include "crumble/fracture/masks.hpp"
#include "crumble/fracture/surface.hpp"
#include "render/image.hpp"
#include "render/offscreen_context.hpp"
#include "render/renderer.hpp"

namespace crumble::app {
namespace {

constexpr int kWidth = 252, kHeight = 226, kStrip = 34, kColumns = 4;  // pixels
constexpr double kSize = 0.02;                                         // of the tetrahedron: radius of its base, metres
constexpr double kSwelling = 1.3;
constexpr double kRodRadius = 0.022 * kSize;
constexpr render::Rgb kPaper = {250, 250, 248}, kInk = {45, 45, 45};

struct PatternOptions {
  std::string mode = "cracks", out;
};

struct Tile {
  SurfaceMode mode;
  unsigned mask;
};

render::Camera camera() {
  constexpr double kReach = kSwelling * kSize;
  return render::fit_camera({-kReach, -0.6 * kReach, 0}, {kReach, 1.12 * kReach, 0}, {0.15, -0.1, -1}, 0.4,
                            1.0 * kWidth / kHeight, 0);
}

TetMesh make_drawn_tetrahedron() {
  Vector<Vec3> nodes{{0, 0, kSize}};
  for (int k = 0; k < 3; ++k) {  // clockwise from the top
    const double angle = kPi / 2 - k * 2 * kPi / 3;
    nodes.push_back({kSize * cos_exact(angle), kSize * sin_exact(angle), 0});
  }
  return make_tet_mesh(std::move(nodes), {{0, 1, 2, 3}});
}

VecArray swollen(const TetMesh& mesh) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : mesh.positions) middle += p / 4;
  VecArray nodes(mesh.positions);
  for (std::size_t i = 0; i < 4; ++i) nodes.set(i, middle + kSwelling * (mesh.positions[i] - middle));
  return nodes;
}

render::RenderMesh body_mesh(const TetMesh& mesh, VecView nodes, const Tile& tile) {
  std::array<std::uint8_t, 6> intact{};
  for (std::size_t s = 0; s < 6; ++s) intact[s] = (tile.mask >> s & 1u) == 0;
  std::array<std::uint32_t, 4> fragments{};
  for (std::size_t i = 0; i < 4; ++i) fragments[i] = kCutMasks[tile.mask].piece[i];
  SurfaceExtractor surface(mesh, {.mode = tile.mode});
  surface.rebuild({nodes, intact, fragments});

  const auto copy = [](const auto& from, auto& to) { to.assign(from.begin(), from.end()); };
  render::RenderMesh drawn;
  copy(surface.positions(), drawn.positions);
  copy(surface.rest_positions(), drawn.rest_positions);
  copy(surface.triangles(), drawn.triangles);
  copy(surface.corner_normals(), drawn.corner_normals);
  drawn.materials.assign(drawn.triangles.size(), render::Material::interior);
  std::fill_n(drawn.materials.begin(), surface.skin_triangle_count(), render::Material::skin);
  return drawn;
}

// A six-sided prism.
render::RenderMesh rod(const Vec3& from, const Vec3& to) {
  constexpr std::uint32_t kSides = 6;
  const Vec3 along = normalized(to - from);
  const Vec3 across = normalized(cross(along, std::abs(along.z()) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0)));
  const Vec3 third = cross(along, across);
  TriangleMesh mesh;
  for (std::uint32_t k = 0; k < kSides; ++k) {
    const double angle = 2 * kPi * k / kSides;
    const Vec3 offset = kRodRadius * (cos_exact(angle) * across + sin_exact(angle) * third);
    mesh.vertices.push_back(from + offset);
    mesh.vertices.push_back(to + offset);
    const std::uint32_t a = 2 * k, b = 2 * ((k + 1) % kSides);
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
    if (k < 2) continue;
    mesh.triangles.push_back({0, a, a - 2});
    mesh.triangles.push_back({1, a - 1, a + 1});
  }
  return make_render_mesh(mesh, Vector<render::Material>(mesh.triangles.size(), render::Material::wood), 40);
}

// An intact spring from node to node; of a cut one what is left at both, half its rest length each, in dashes.
void add_spring(const TetMesh& mesh, VecView nodes, std::size_t spring, bool is_cut,
                Vector<render::RenderMesh>& meshes) {
  constexpr double kDash = 1.0 / 7;
  const auto [a, b] = mesh.springs[spring];
  if (!is_cut) {
    meshes.push_back(rod(nodes[a], nodes[b]));
    return;
  }
  const Vec3 half = (mesh.positions[b] - mesh.positions[a]) / 2;
  for (int dash = 0; dash < 7; dash += 2) {
    const double from = dash * kDash, to = (dash + 1) * kDash;
    meshes.push_back(rod(nodes[a] + from * half, nodes[a] + to * half));
    meshes.push_back(rod(nodes[b] - from * half, nodes[b] - to * half));
  }
}

void draw_centered(render::Image& image, double x, double y, const std::string& text, int scale, render::Rgb colour) {
  const int left = static_cast<int>(std::lround(x - 0.5 * render::text_width(text, scale)));
  draw_text(image, left, static_cast<int>(std::lround(y - 3.5 * scale)), text, scale, colour);
}

// Numbers the nodes, a little outside of where they are seen.
void draw_node_names(const render::Camera& camera, VecView nodes, render::Image& image) {
  const render::Mat4 to_clip =
      render::perspective_matrix(camera.vertical_fov, 1.0 * kWidth / kHeight, 0.01, 1) * render::view_matrix(camera);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Vec3 beside = nodes[i] * (1 + 0.14 * kSize / norm(nodes[i]));
    const Eigen::Vector4f clip = to_clip * Eigen::Vector4f(beside.cast<float>().homogeneous());
    const double x = clip.x() / clip.w(), y = clip.y() / clip.w();
    const double column = 0.5 * (1 + x) * kWidth, row = 0.5 * (1 - y) * kHeight;
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      draw_centered(image, column + dx, row + dy, std::to_string(i), 2, kPaper);
    }
    draw_centered(image, column, row, std::to_string(i), 2, kInk);
  }
}

std::string cut_text(unsigned mask) {
  if (mask == 0) return "nothing cut";
  std::string text = "cut";
  for (std::size_t s = 0; s < 6; ++s) {
    if ((mask >> s & 1u) != 0) text += " " + std::to_string(kTetEdges[s][0]) + std::to_string(kTetEdges[s][1]);
  }
  return text;
}

std::string name_text(unsigned mask) {
  const int pieces = kCutMasks[mask].piece_count;
  return "mask " + std::to_string(mask) + ", " + std::to_string(pieces) + (pieces == 1 ? " piece" : " pieces");
}

render::Image draw_tile(render::Renderer& renderer, const Tile& tile) {
  const TetMesh mesh = make_drawn_tetrahedron();
  const VecArray nodes = swollen(mesh);
  render::Scene scene;
  scene.floor_height = std::nullopt;
  scene.camera = camera();
  scene.meshes.push_back(body_mesh(mesh, nodes, tile));
  for (std::size_t s = 0; s < 6; ++s) add_spring(mesh, nodes, s, (tile.mask >> s & 1u) != 0, scene.meshes);
  render::Image picture = renderer.draw(scene, kWidth, kHeight);
  draw_node_names(scene.camera, nodes, picture);
  render::Image framed = render::make_image(kWidth, kHeight + kStrip, kPaper);
  std::copy(picture.pixels.begin(), picture.pixels.end(), framed.pixels.begin());
  draw_centered(framed, 0.5 * kWidth, kHeight + 9, name_text(tile.mask), 1, kInk);
  draw_centered(framed, 0.5 * kWidth, kHeight + 24, cut_text(tile.mask), 1, kInk);
  return framed;
}

render::Image draw_legend() {
  constexpr std::array<const char*, 4> kLines{"smooth: outside of the body", "rough: laid open by cuts",
                                              "rod: intact spring", "dashes: cut spring, half of it at each node"};
  render::Image legend = render::make_image(kWidth, kHeight + kStrip, kPaper);
  double y = 0.5 * kHeight - 30;
  for (const char* line : kLines) draw_centered(legend, 0.5 * kWidth, y += 20, line, 1, kInk);
  return legend;
}

SurfaceMode parse_mode(const std::string& name) {
  if (name == "cracks") return SurfaceMode::cracks;
  if (name == "paper") return SurfaceMode::paper;
  throw Error(Code::unsupported, "--mode '" + name + "' is not known; there are: cracks paper");
}

void draw_patterns(const PatternOptions& options) {
  const SurfaceMode mode = parse_mode(options.mode);
  const std::filesystem::path out = options.out;
  if (out.extension() != ".png") throw Error(Code::unsupported, "--out '" + options.out + "' must end in .png");
  render::OffscreenContext context;
  render::Renderer renderer;
  Vector<render::Image> tiles;
  for (const unsigned mask : kCutClasses) tiles.push_back(draw_tile(renderer, {mode, mask}));
  tiles.push_back(draw_legend());
  render::write_png(render::tile(tiles, kColumns, 4, kPaper), out);
}

}  // namespace

void add_patterns(CLI::App& app) {
  auto* command = app.add_subcommand("patterns", "Draw every class of cut tetrahedra");
  auto options = std::make_shared<PatternOptions>();
  command->add_option("--mode", options->mode, "cracks or paper: what a cut spring opens")->capture_default_str();
  command->add_option("--out", options->out, "Picture, .png")->required();
  command->callback([options] { draw_patterns(*options); });
}

}  // namespace crumble::app
