// The cube and the stick of the rig, made with crumble.hpp.
#pragma once

#include <string>
#include <vector>

#include "capi/rig.hpp"
#include "crumble/crumble.hpp"

namespace crumble {

/// `call` throws this code, and a text with every one of `words`.
template <class Call>
void expect_error(crumble_result code, const std::vector<std::string>& words, Call&& call) {
  try {
    call();
    ADD_FAILURE() << "nothing was thrown instead of " << name_of(code);
  } catch (const c::Error& error) {
    EXPECT_EQ(name_of(code), error.name());
    EXPECT_EQ(code, error.code());
    const std::string text = error.what();
    for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << text << "\nlacks " << word;
  }
}

/// The cube and the stick of the rig, made with crumble.hpp, beside those made with crumble.h.
class Hpp : public CapiTest {
 protected:
  c::Mesh make_body() const { return c::Mesh::create_from_tets(cube.positions, cube.tetrahedra); }
  c::Sim make() const {
    c::SimDef weak;
    weak.length_limit = 1.1;
    c::Sim made(body, weak);
    c::ToolDef stick;
    stick.static_friction = 3;
    stick.dynamic_friction = 1.5;
    EXPECT_EQ(made.add_tool(stick), 0u);
    made.fix_below(1e-6);
    return made;
  }
  static crumble_wrench press(c::Sim& body, int first, int last) {
    crumble_wrench felt{};
    for (int step = first; step <= last; ++step) felt = body.step(pose_at(step));
    return felt;
  }

  c::Mesh body = make_body();
  c::Sim twin = make();
};

}  // namespace crumble
