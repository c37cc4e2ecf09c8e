#include "crumble/bubblemesh/presets.hpp"

#include <gtest/gtest.h>

#include "crumble/base/hash.hpp"

namespace crumble {
namespace {

std::uint64_t hash_of(const TetMesh& mesh) {
  Hash hash;
  for (const Vec3& p : mesh.positions) {
    hash.add(p.x());
    hash.add(p.y());
    hash.add(p.z());
  }
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (const std::uint32_t v : t) hash.add(std::uint64_t{v});
  }
  return hash.value();
}

struct Expected {
  PaperBody body;
  double edge_variation;     // greatest
  double edge_disagreement;  // of twice the springs with the paper's edges, greatest, relative
  std::uint64_t golden;
};
class PaperBodies : public testing::TestWithParam<Expected> {};

TEST_P(PaperBodies, ReachTheNumbersOfThePaper) {
  const PaperBodyFacts facts = paper_body_facts(GetParam().body);
  const BubbleMesh result = generate_paper_body(GetParam().body);
  const MeshQuality& q = result.quality;
  EXPECT_EQ(result.mesh.surface_node_count(), facts.surface_nodes);
  EXPECT_EQ(result.mesh.node_count(), facts.surface_nodes + facts.inside_nodes);
  EXPECT_NEAR(2.0 * static_cast<double>(result.mesh.springs.size()) / facts.paper_edges, 1,
              GetParam().edge_disagreement);
  EXPECT_GE(q.dihedral_min, 36);
  EXPECT_LE(q.dihedral_max, 135);
  EXPECT_LE(q.edge_variation, GetParam().edge_variation);
  EXPECT_EQ(q.euler_defect, 0);
  EXPECT_EQ(q.boundary_defects.total(), 0u);
  EXPECT_TRUE(result.warnings.empty());
}

// The same bits from every compiler at every level of optimisation.
TEST_P(PaperBodies, HaveTheirGoldenHash) {
  EXPECT_EQ(hash_of(generate_paper_body(GetParam().body).mesh), GetParam().golden);
}

INSTANTIATE_TEST_SUITE_P(All, PaperBodies,
                         testing::Values(Expected{PaperBody::cube, 0.12, 0.02, 0xf65bac874bfca4bd},
                                         Expected{PaperBody::slab, 0.12, 0.02, 0x34809237d1366fde},
                                         Expected{PaperBody::globe, 0.12, 0.02, 0x0b2467440b2b033a},
                                         Expected{PaperBody::globe_literal, 0.16, 0.06, 0x5bd80361c19fa8be}),
                         [](const auto& suite) { return std::string(paper_body_facts(suite.param.body).name); });

TEST(PaperBodiesUnforced, ComeNearThePaperByThemselves) {
  for (const PaperBody body : {PaperBody::cube, PaperBody::slab}) {
    const PaperBodyFacts facts = paper_body_facts(body);
    BubbleMeshOptions options;
    options.spacing = paper_options(body).spacing;
    const BubbleMesh result = generate(*make_paper_shape(body), options);
    EXPECT_NEAR(static_cast<double>(result.mesh.node_count()) / (facts.surface_nodes + facts.inside_nodes), 1, 0.08);
  }
}

}  // namespace
}  // namespace crumble
