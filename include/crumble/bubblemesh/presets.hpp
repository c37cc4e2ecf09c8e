// The three bodies of the paper, with its numbers of nodes.
#pragma once

#include <memory>
#include <string_view>

#include "crumble/bubblemesh/generate.hpp"

namespace crumble {

enum class PaperBody : std::uint8_t {
  cube,           // §2.2, §3.2: 30 x 30 x 30 mm, balls of 2.2 mm radius, 306 nodes on the surface + 294 inside
  slab,           // §3.3: 30 x 30 mm and 10 mm high, balls of 1.5 mm radius, 382 + 314
  globe,          // §3.3: radius 20 mm, balls of 2.2 mm radius, 305 + 370; the paper's two numbers read as swapped
  globe_literal,  // the same with 370 + 305, as printed
};

struct PaperBodyFacts {
  std::string_view name;
  std::uint32_t surface_nodes, inside_nodes;
  std::uint32_t paper_edges;  // as printed: nearly twice the number of springs, see docs/paper.md
};
PaperBodyFacts paper_body_facts(PaperBody body);

std::unique_ptr<Shape> make_paper_shape(PaperBody body);
BubbleMeshOptions paper_options(PaperBody body);
/// generate(make_paper_shape(body), paper_options(body))
BubbleMesh generate_paper_body(PaperBody body);

}  // namespace crumble
