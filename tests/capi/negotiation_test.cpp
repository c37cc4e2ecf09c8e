// struct_size: programs that are older or newer than the library.
#include <cstring>

#include "capi/rig.hpp"

namespace crumble {
namespace {

class Negotiation : public CapiTest {
 protected:
  // A definition with room behind it, as a program with a newer header has one.
  struct NewerDef {
    crumble_sim_def def;
    double more[3];
  };
  double stiffness_of(crumble_sim made) {
    crumble_sim_def out{};
    out.struct_size = sizeof out;
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_get_def(made, &out));
    return out.stiffness;
  }
};

TEST_F(Negotiation, AnOlderProgramGetsDefaultsForTheRest) {
  // it knows the fields up to stiffness; what lies behind them is not its struct
  crumble_sim_def older;
  std::memset(&older, 0xff, sizeof older);
  const auto size = static_cast<std::uint32_t>(offsetof(crumble_sim_def, damping_ratio));
  ASSERT_OK(crumble_sim_def_init(&older, size));
  EXPECT_EQ(older.struct_size, size);
  EXPECT_EQ(older.stiffness, 30);
  for (std::size_t byte = size; byte < sizeof older; ++byte) {
    ASSERT_EQ(reinterpret_cast<const unsigned char*>(&older)[byte], 0xff) << "byte " << byte << " is the caller's";
  }

  older.stiffness = 77;
  crumble_sim made = nullptr;
  ASSERT_OK(crumble_sim_create(mesh, &older, &made));
  crumble_sim_def full{};
  full.struct_size = sizeof full;
  ASSERT_OK(crumble_sim_get_def(made, &full));
  EXPECT_EQ(full.stiffness, 77);
  EXPECT_EQ(full.damping_ratio, 30);
  EXPECT_EQ(full.length_limit, 1.3);
  EXPECT_EQ(full.tau, 1e-3);
  EXPECT_EQ(full.iterations, 1u);
  EXPECT_EQ(full.struct_size, sizeof full);
  ASSERT_OK(crumble_sim_destroy(made));
}

// crumble_sim_def ended behind `reserved` once.
TEST_F(Negotiation, AProgramWithoutPrecisionKernelAndThreadsRunsAsItDid) {
  press(1, 60);
  const std::uint64_t as_now = hash();
  ASSERT_OK(crumble_sim_destroy(sim));
  std::memset(&def.precision, 0xff, sizeof def - offsetof(crumble_sim_def, precision));  // the program's own memory
  def.struct_size = offsetof(crumble_sim_def, precision);
  ASSERT_EQ(def.struct_size, 104u);
  sim = make_sim();
  press(1, 60);
  EXPECT_EQ(hash(), as_now);
  crumble_sim_def full{};
  full.struct_size = sizeof full;
  ASSERT_OK(crumble_sim_get_def(sim, &full));
  EXPECT_EQ(full.precision, std::uint32_t{CRUMBLE_PRECISION_FLOAT64});
  EXPECT_EQ(full.threads, 1u);
  EXPECT_EQ(full.kernel, nullptr);
  EXPECT_EQ(full.host_threads, nullptr);
}

TEST_F(Negotiation, ANewerProgramIsServedWhileItsNewFieldsAreZero) {
  NewerDef newer;
  std::memset(&newer, 0xff, sizeof newer);
  ASSERT_OK(crumble_sim_def_init(&newer.def, sizeof newer));
  EXPECT_EQ(newer.def.struct_size, sizeof newer);
  for (const double each : newer.more) EXPECT_EQ(each, 0);
  newer.def.stiffness = 55;
  crumble_sim made = nullptr;
  ASSERT_OK(crumble_sim_create(mesh, &newer.def, &made));
  EXPECT_EQ(stiffness_of(made), 55);
  ASSERT_OK(crumble_sim_destroy(made));

  newer.more[2] = 1e-300;
  made = nullptr;
  expect_failure(CRUMBLE_E_VERSION, crumble_sim_create(mesh, &newer.def, &made),
                 {"crumble_sim_create", std::to_string(sizeof newer) + " bytes"});
  EXPECT_EQ(made, nullptr);
}

TEST_F(Negotiation, SizesThatNoVersionHasAreRefused) {
  for (const std::uint32_t size : {1u, 4u, 7u, 103u, 105u, 177u, 4104u, 0xfffffff8u, 0xffffffffu}) {
    crumble_sim_def bad = def;
    bad.struct_size = size;
    crumble_sim made = nullptr;
    expect_failure(CRUMBLE_E_VERSION, crumble_sim_create(mesh, &bad, &made), {"struct_size", std::to_string(size)});
    EXPECT_EQ(made, nullptr);
    crumble_sim_def untouched = def;
    EXPECT_RESULT(CRUMBLE_E_VERSION, crumble_sim_def_init(&untouched, size));
    EXPECT_EQ(std::memcmp(&untouched, &def, sizeof def), 0);
  }
}

TEST_F(Negotiation, AForgottenSizeIsToldApart) {
  crumble_mesh_def mesh_def{};
  crumble_mesh made_mesh = nullptr;
  crumble_sim_def sim_def{};
  crumble_sim made = nullptr;
  crumble_tool_def tool_def{};
  crumble_wall_def wall_def{};
  crumble_step_info step_info{};
  crumble_counters counters{};
  crumble_profile profile{};
  crumble_sim_info sim_info{};
  crumble_mesh_info mesh_info{};
  crumble_surface_info surface_info{};
  crumble_reader_def reader_def{};
  crumble_reader reader = nullptr;
  crumble_reader_info reader_info{};
  crumble_fragment_info fragment_info{};
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_reader_def_init(&reader_def, 0));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_reader_create(sim, &reader_def, &reader));
  ASSERT_OK(crumble_reader_create(sim, nullptr, &reader));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_reader_update(reader, &reader_info));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_reader_get_fragment(reader, 0, &fragment_info));
  ASSERT_OK(crumble_reader_destroy(reader));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_mesh_create(&mesh_def, &made_mesh));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_create(mesh, &sim_def, &made));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_configure(sim, &sim_def));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_get_def(sim, &sim_def));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_add_tool(sim, &tool_def, nullptr));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_add_wall(sim, &wall_def));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_get_step_info(sim, &step_info));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_get_counters(sim, &counters));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_get_profile(sim, &profile));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_get_info(sim, &sim_info));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_mesh_get_info(mesh, &mesh_info));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_extract_surface(sim, &surface_info));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_mesh_def_init(&mesh_def, 0));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_sim_def_init(&sim_def, 0));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_tool_def_init(&tool_def, 0));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_wall_def_init(&wall_def, 0));
}

TEST_F(Negotiation, OutputStructsAreFilledAsFarAsTheyGo) {
  press(1, 5);
  crumble_step_info older;
  std::memset(&older, 0xee, sizeof older);
  older.struct_size = offsetof(crumble_step_info, time);
  ASSERT_OK(crumble_sim_get_step_info(sim, &older));
  EXPECT_EQ(older.step, 5u);
  EXPECT_EQ(older.bad_node, 0xeeeeeeeeu);

  struct {
    crumble_step_info info;
    std::uint64_t more[2];
  } newer;
  std::memset(&newer, 0xee, sizeof newer);
  newer.info.struct_size = sizeof newer;
  ASSERT_OK(crumble_sim_get_step_info(sim, &newer.info));
  EXPECT_EQ(newer.info.step, 5u);
  EXPECT_EQ(newer.info.struct_size, sizeof newer);
  EXPECT_EQ(newer.more[0], 0u);
  EXPECT_EQ(newer.more[1], 0u);
}

TEST_F(Negotiation, ReservedFieldsStayZero) {
  def.reserved = 1;
  crumble_sim made = nullptr;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_create(mesh, &def, &made), {"reserved", "1"});
  tool.reserved = 2;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_add_tool(sim, &tool, nullptr), {"reserved", "2"});
}

}  // namespace
}  // namespace crumble
