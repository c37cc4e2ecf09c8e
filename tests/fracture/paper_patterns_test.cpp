// The paper's drawing: each solid is closed, has its volume, and inner faces cancel.
#include "fracture/paper_patterns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <tuple>

#include "crumble/base/memory.hpp"
#include "states.hpp"

namespace crumble {
namespace {

using namespace fracture_test;
using surface_patterns::copy_of;
using surface_patterns::kCorners;
using surface_patterns::kPaperPatterns;
using surface_patterns::MaskPatterns;
using surface_patterns::PatternTriangle;
using surface_patterns::site_of;
using surface_patterns::VertexCode;

// The corner that a vertex belongs to, and where its spring leads, or the corner itself.
std::array<std::uint8_t, 2> ends_of(VertexCode code) {
  const std::size_t site = site_of(code);
  if (site >= kCorners) {
    const auto corner = static_cast<std::uint8_t>(site - kCorners);
    return {corner, corner};
  }
  const auto [a, b] = kTetEdges[site];
  return copy_of(code) == 0 ? std::array{a, b} : std::array{b, a};
}

Vector<PatternTriangle> all_triangles(const MaskPatterns& patterns) {
  Vector<PatternTriangle> all(patterns.interior.begin(), patterns.interior.begin() + patterns.interior_count);
  for (std::size_t f = 0; f < 4; ++f) {
    all.insert(all.end(), patterns.skin[f].begin(), patterns.skin[f].begin() + patterns.skin_count[f]);
  }
  return all;
}

// Maximal sets of pairwise connected corners, written out by asking every set.
Vector<unsigned> cliques_of(unsigned mask) {
  std::array<unsigned, 4> joined{1, 2, 4, 8};  // bits
  for (std::size_t s = 0; s < 6; ++s) {
    if ((mask >> s & 1u) != 0) continue;
    const auto [a, b] = kTetEdges[s];
    joined[a] |= 1u << b, joined[b] |= 1u << a;
  }
  Vector<unsigned> cliques;
  for (unsigned set = 1; set < 16; ++set) {
    unsigned common = 15;
    for (unsigned c = 0; c < 4; ++c) common &= (set >> c & 1u) != 0 ? joined[c] : 15u;
    if (common == set) cliques.push_back(set);  // all of them joined, and nobody else with all
  }
  return cliques;
}

Vec3 place(VertexCode code, const std::array<Vec3, 4>& corners) {
  const auto [from, to] = ends_of(code);
  return (corners[from] + corners[to]) / 2;
}

using EdgeCounts = std::map<std::pair<std::uint64_t, std::uint64_t>, int>;

// Forward minus backward uses: all zero when every directed edge is balanced.
void count_edge(EdgeCounts& counts, std::uint64_t a, std::uint64_t b) {
  a < b ? ++counts[{a, b}] : --counts[{b, a}];
}
bool is_balanced(const EdgeCounts& counts) {
  return std::ranges::all_of(counts, [](const auto& entry) { return entry.second == 0; });
}

const std::array<Vec3, 4> kCorner{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};

struct Solid {
  Vector<PatternTriangle> triangles;
  double share = 0;  // of the tetrahedron's volume
  bool closed = false;
};

// The triangles on the points of one clique; no triangle is on those of two.
Solid solid_of(unsigned mask, unsigned clique) {
  Solid solid;
  EdgeCounts edges;
  for (const PatternTriangle& triangle : all_triangles(kPaperPatterns[mask])) {
    const auto& codes = triangle.vertices;
    if (!std::ranges::all_of(codes, [&](VertexCode code) { return (clique >> ends_of(code)[0] & 1u) != 0; })) continue;
    solid.triangles.push_back(triangle);
    for (std::size_t k = 0; k < 3; ++k) count_edge(edges, codes[k], codes[(k + 1) % 3]);
    solid.share += dot(place(codes[0], kCorner), cross(place(codes[1], kCorner), place(codes[2], kCorner)));
  }
  solid.closed = is_balanced(edges);
  return solid;
}

const std::map<unsigned, Vector<double>>& expected_shares() {  // by class, in eighths, ascending
  static const std::map<unsigned, Vector<double>> kShares{
      {0, {8}},        {1, {4, 4}},     {3, {2, 6}},  {7, {1, 7}},     {11, {2, 2, 2}},   {12, {2, 2, 2, 2}},
      {13, {2, 3, 3}}, {15, {1, 3, 3}}, {30, {4, 4}}, {31, {1, 1, 4}}, {63, {1, 1, 1, 1}}};
  return kShares;
}

double volume_share(unsigned mask) {
  double eighths = 0;
  for (const double share : expected_shares().at(kCutMasks[mask].least_mask)) eighths += share;
  return eighths / 8;
}

TEST(PaperPatterns, SolidsAreClosedAndHaveTheirVolumes) {
  for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
    std::size_t triangles = 0;
    Vector<double> eighths;
    for (const unsigned clique : cliques_of(mask)) {
      const Solid solid = solid_of(mask, clique);
      EXPECT_TRUE(solid.closed) << "mask " << mask << " clique " << clique;
      for (const PatternTriangle& triangle : solid.triangles) {
        EXPECT_EQ(triangle.owner, std::countr_zero(clique)) << "mask " << mask;
      }
      triangles += solid.triangles.size();
      eighths.push_back(8 * solid.share);
    }
    std::ranges::sort(eighths);
    EXPECT_EQ(eighths, expected_shares().at(kCutMasks[mask].least_mask)) << "mask " << mask;
    EXPECT_EQ(triangles, all_triangles(kPaperPatterns[mask]).size()) << "mask " << mask;
    EXPECT_LE(kPaperPatterns[mask].interior_count, 8) << "mask " << mask;
  }
}

// Solids of one tetrahedron touch, but do not overlap.
TEST(PaperPatterns, NoPointIsInTwoSolids) {
  Random random(31);
  for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
    int inside_some = 0, drawn = 0;
    for (int sample = 0; sample < 400; ++sample) {
      const Vec3 point(random.uniform(), random.uniform(), random.uniform());
      if (point.x() + point.y() + point.z() > 1) continue;
      ++drawn;
      int solids = 0;
      for (const unsigned clique : cliques_of(mask)) {
        const Solid solid = solid_of(mask, clique);
        solids += std::ranges::all_of(solid.triangles, [&](const PatternTriangle& triangle) {
          const auto& [a, b, c] = triangle.vertices;
          return orient(place(a, kCorner), place(b, kCorner), place(c, kCorner), point) < 0;
        });
      }
      ASSERT_LE(solids, 1) << "mask " << mask;
      inside_some += solids;
    }
    EXPECT_NEAR(1.0 * inside_some / drawn, volume_share(mask), 0.25) << "mask " << mask;
  }
}

// Facets, whichever way a four-sided one is split, as points in order from the least.
Vector<Vector<int>> facets_of(const Vector<PatternTriangle>& triangles, const auto& rename, bool mirror) {
  std::set<Vector<int>> facets;
  for (const auto& [vertices, owner, fourth] : triangles) {
    Vector<int> facet;
    for (const VertexCode code : vertices) facet.push_back(rename(code));
    if (fourth != vertices[0]) facet.push_back(rename(fourth));
    if (mirror) std::ranges::reverse(facet);
    std::ranges::rotate(facet, std::ranges::min_element(facet));
    facets.insert(facet);
  }
  return {facets.begin(), facets.end()};
}

TEST(PaperPatterns, RelabellingRelabelsTheDrawing) {
  const auto name = [](std::uint8_t from, std::uint8_t to) { return 4 * from + to; };
  const auto plain = [&](VertexCode code) { return name(ends_of(code)[0], ends_of(code)[1]); };
  std::array<std::uint8_t, 4> image{0, 1, 2, 3};
  do {
    const auto renamed = [&](VertexCode code) { return name(image[ends_of(code)[0]], image[ends_of(code)[1]]); };
    const bool mirror = orient(kCorner[image[0]], kCorner[image[1]], kCorner[image[2]], kCorner[image[3]]) < 0;
    for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
      unsigned image_mask = 0;
      for (std::size_t s = 0; s < 6; ++s) {
        const std::uint8_t a = image[kTetEdges[s][0]], b = image[kTetEdges[s][1]];
        const std::array least_first{std::min(a, b), std::max(a, b)};
        const auto to = static_cast<unsigned>(std::ranges::find(kTetEdges, least_first) - kTetEdges.begin());
        image_mask |= (mask >> s & 1u) << to;
      }
      EXPECT_EQ(facets_of(all_triangles(kPaperPatterns[mask]), renamed, mirror),
                facets_of(all_triangles(kPaperPatterns[image_mask]), plain, false))
          << mask << " as " << image_mask;
    }
  } while (std::next_permutation(image.begin(), image.end()));
}

// The two triangles of a four-sided facet name each other's far corner and are flat together at rest; the table keeps
// the pair together, and the skin stays in its face.
TEST(PaperPatterns, FourSidedFacetsArePairs) {
  for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
    const Vector<PatternTriangle> triangles = all_triangles(kPaperPatterns[mask]);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto& [a, b, c] = triangles[t].vertices;
      if (triangles[t].fourth == a) continue;
      ASSERT_LT(t + 1, triangles.size());
      const PatternTriangle& other = triangles[++t];
      EXPECT_EQ(other.vertices, (std::array<VertexCode, 3>{c, triangles[t - 1].fourth, a}));
      EXPECT_EQ(other.fourth, b);
      const auto at = [](VertexCode code) { return place(code, kCorner); };
      EXPECT_EQ(orient(at(a), at(b), at(c), at(triangles[t - 1].fourth)), 0);
    }
    for (std::size_t f = 0; f < 4; ++f) {
      for (std::size_t t = 0; t < kPaperPatterns[mask].skin_count[f]; ++t) {
        for (const VertexCode code : kPaperPatterns[mask].skin[f][t].vertices) {
          EXPECT_NE(ends_of(code)[0], f);
          EXPECT_NE(ends_of(code)[1], f);
        }
      }
    }
  }
}

// A whole body drawn by the table: the balance of its directed edges and the volume inside.
struct Drawing {
  EdgeCounts edges;
  double volume = 0, expected_volume = 0;
};

struct SortedTetrahedron {
  Tetrahedron nodes;  // ascending
  bool flipped;
};

SortedTetrahedron sorted(const TetMesh& mesh, const Tetrahedron& given) {
  SortedTetrahedron cell{given, false};
  std::ranges::sort(cell.nodes);
  const auto& [a, b, c, d] = cell.nodes;
  cell.flipped = orient(mesh.positions[a], mesh.positions[b], mesh.positions[c], mesh.positions[d]) < 0;
  return cell;
}

unsigned mask_of(const TetMesh& mesh, const Tetrahedron& nodes, const Flags& intact) {
  unsigned mask = 0;
  for (std::size_t s = 0; s < 6; ++s) {
    const Edge edge{nodes[kTetEdges[s][0]], nodes[kTetEdges[s][1]]};
    const auto spring = static_cast<std::size_t>(std::ranges::lower_bound(mesh.springs, edge) - mesh.springs.begin());
    mask |= intact[spring] == 0 ? 1u << s : 0u;
  }
  return mask;
}

void draw(const TetMesh& mesh, const SortedTetrahedron& cell, const PatternTriangle& triangle, Drawing& drawing) {
  auto codes = triangle.vertices;
  if (cell.flipped) std::swap(codes[1], codes[2]);
  std::array<std::uint64_t, 3> names{};
  std::array<Vec3, 3> at;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t from = cell.nodes[ends_of(codes[k])[0]], to = cell.nodes[ends_of(codes[k])[1]];
    names[k] = std::uint64_t{from} << 32u | to;
    at[k] = (mesh.positions[from] + mesh.positions[to]) / 2;
  }
  for (std::size_t k = 0; k < 3; ++k) count_edge(drawing.edges, names[k], names[(k + 1) % 3]);
  drawing.volume += dot(at[0], cross(at[1], at[2])) / 6;
}

Drawing draw_body(const TetMesh& mesh, const Flags& intact) {
  std::set<std::array<std::uint32_t, 3>> outer;
  for (Triangle face : mesh.boundary) {
    std::ranges::sort(face);
    outer.insert(face);
  }
  Drawing drawing;
  for (const Tetrahedron& given : mesh.tetrahedra) {
    const SortedTetrahedron cell = sorted(mesh, given);
    const auto& [a, b, c, d] = cell.nodes;
    const unsigned mask = mask_of(mesh, cell.nodes, intact);
    const MaskPatterns& patterns = kPaperPatterns[mask];
    for (std::size_t t = 0; t < patterns.interior_count; ++t) draw(mesh, cell, patterns.interior[t], drawing);
    const std::array<Triangle, 4> faces{Triangle{b, c, d}, {a, c, d}, {a, b, d}, {a, b, c}};
    for (std::size_t f = 0; f < 4; ++f) {
      if (!outer.contains(faces[f])) continue;
      for (std::size_t t = 0; t < patterns.skin_count[f]; ++t) draw(mesh, cell, patterns.skin[f][t], drawing);
    }
    const double whole =
        std::abs(orient(mesh.positions[a], mesh.positions[b], mesh.positions[c], mesh.positions[d])) / 6;
    drawing.expected_volume += volume_share(mask) * whole;
  }
  return drawing;
}

// The part of one tetrahedron in its face with the least three nodes: area, and the way round it.
Drawing draw_face(const TetMesh& mesh, const Tetrahedron& given, std::size_t face, const Flags& intact) {
  Drawing drawing;
  const SortedTetrahedron cell = sorted(mesh, given);
  const MaskPatterns& patterns = kPaperPatterns[mask_of(mesh, cell.nodes, intact)];
  for (std::size_t t = 0; t < patterns.skin_count[face]; ++t) draw(mesh, cell, patterns.skin[face][t], drawing);
  return drawing;
}

TEST(PaperPatterns, TwoTetrahedraWithACommonFaceInEveryState) {
  Random random(32);
  for (int numbering = 0; numbering < 10; ++numbering) {
    const TetMesh mesh =
        make_renumbered(two_tetrahedra_points(), {{0, 1, 2, 3}, {0, 2, 1, 4}}, random_order(5, random));
    for (unsigned cut = 0; cut < 512; ++cut) {
      Flags intact(9);
      for (std::size_t s = 0; s < 9; ++s) intact[s] = (cut >> s & 1u) == 0;
      const Drawing drawing = draw_body(mesh, intact);
      ASSERT_TRUE(is_balanced(drawing.edges)) << "cut " << cut;
      ASSERT_NEAR(drawing.volume, drawing.expected_volume, 1e-14) << "cut " << cut;
    }
  }
}

// Both tetrahedra have the same parts in the face between them: together the two drawings cancel, edge by edge.
TEST(PaperPatterns, PartsInAnInnerFaceCancel) {
  const TetMesh mesh = make_tet_mesh(two_tetrahedra_points(), {{0, 1, 2, 3}, {0, 2, 1, 4}});
  for (unsigned cut = 0; cut < 512; ++cut) {
    Flags intact(9);
    for (std::size_t s = 0; s < 9; ++s) intact[s] = (cut >> s & 1u) == 0;
    Drawing above = draw_face(mesh, mesh.tetrahedra[0], 3, intact);
    const Drawing below = draw_face(mesh, mesh.tetrahedra[1], 3, intact);
    ASSERT_FALSE(is_balanced(above.edges));
    for (const auto& [edge, count] : below.edges) above.edges[edge] += count;
    ASSERT_TRUE(is_balanced(above.edges)) << "cut " << cut;
  }
}

TEST(PaperPatterns, RandomBodiesAreClosed) {
  Random random(33);
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.02}, 0.005);
  const double body_volume = volume(mesh);
  for (int state = 0; state <= 50; ++state) {
    const Drawing drawing = draw_body(mesh, random_flags(mesh.springs.size(), 0.02 * state, random));
    ASSERT_TRUE(is_balanced(drawing.edges)) << state;
    ASSERT_NEAR(drawing.volume, drawing.expected_volume, 1e-12 * body_volume) << state;
  }
}

}  // namespace
}  // namespace crumble
