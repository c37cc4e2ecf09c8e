// examples/chai3d/crumble_chai3d.hpp against a double of CHAI3D's classes.
#include <gtest/gtest.h>

#include <cmath>

#include "crumble_chai3d.hpp"
#include "scripted_device.hpp"

namespace {

struct Opened {
  explicit Opened(bool senses_velocity = false) : bridge(device, senses_velocity) {}
  ~Opened() { EXPECT_EQ(crumble_device_destroy(handle), CRUMBLE_OK); }
  void open() { ASSERT_EQ(bridge.open(&handle), CRUMBLE_OK) << crumble_last_error(); }
  crumble_device_sample read() {
    crumble_device_sample sample{};
    sample.struct_size = sizeof sample;
    EXPECT_EQ(crumble_device_read(handle, &sample), CRUMBLE_OK) << crumble_last_error();
    return sample;
  }
  const ScriptedDevice::Sent& last() const { return device->sent.back(); }

  std::shared_ptr<ScriptedDevice> device = std::make_shared<ScriptedDevice>();
  crumble_chai3d::Bridge bridge;
  crumble_device handle = nullptr;
};

// q v q*, spelled out: v + 2 w (u x v) + 2 u x (u x v).
void turn(const double q[4], const double v[3], double out[3]) {
  const double* u = q + 1;
  double once[3], twice[3];
  for (int i = 0; i < 3; ++i) once[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
  for (int i = 0; i < 3; ++i) twice[i] = u[(i + 1) % 3] * once[(i + 2) % 3] - u[(i + 2) % 3] * once[(i + 1) % 3];
  for (int i = 0; i < 3; ++i) out[i] = v[i] + 2 * q[0] * once[i] + 2 * twice[i];
}

TEST(Chai3dBridge, RightUpAndTowardsTheUserStaySo) {
  Opened o(true);
  o.device->script = [](int) { return chai3d::cVector3d(0.03, 0.01, 0.02); };  // towards the user, right, up
  o.device->velocity = chai3d::cVector3d(0.3, 0.1, 0.2);
  o.device->buttons = 5;
  o.open();
  const crumble_device_sample sample = o.read();
  EXPECT_EQ(sample.pose.position[0], 0.01);  // right, up, towards the user
  EXPECT_EQ(sample.pose.position[1], 0.02);
  EXPECT_EQ(sample.pose.position[2], 0.03);
  EXPECT_EQ(sample.linear_velocity[0], 0.1);
  EXPECT_EQ(sample.linear_velocity[1], 0.2);
  EXPECT_EQ(sample.linear_velocity[2], 0.3);
  EXPECT_EQ(sample.buttons, 5u);
  const double force[3] = {1, 2, 3}, torque[3] = {0, 0, 0};
  ASSERT_EQ(crumble_device_write(o.handle, force, torque), CRUMBLE_OK);
  EXPECT_EQ(o.last().force[1], 1);  // right
  EXPECT_EQ(o.last().force[2], 2);  // up
  EXPECT_EQ(o.last().force[0], 3);  // towards the user
}

// A rotation that CHAI3D tells as columns x, y, z of the handle in the room: each column, said in right, up and towards
// the user, must be where crumble's quaternion takes the same axis of the handle.
TEST(Chai3dBridge, AxesOfTheHandleGoWhereTheyWent) {
  const double angles[][3] = {{0.3, -0.5, 0.7}, {0, 0, M_PI / 2}, {M_PI, 0, 0}, {3.1, 0, 0}, {0, 3.13, 0}, {2, 2, -2}};
  for (const auto& a : angles) {
    Opened o;
    o.device->m_specifications.m_sensedRotation = true;
    const double sx = std::sin(a[0]), cx = std::cos(a[0]), sy = std::sin(a[1]), cy = std::cos(a[1]);
    const double sz = std::sin(a[2]), cz = std::cos(a[2]);
    const double r[3][3] = {{cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx},
                            {sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx},
                            {-sy, cy * sx, cy * cx}};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) o.device->rotation(row, column) = r[row][column];
    }
    o.open();
    const crumble_device_sample sample = o.read();
    const int ours_of[3] = {2, 0, 1};  // CHAI3D's x is our z, its y our x, its z our y
    for (int column = 0; column < 3; ++column) {
      double axis[3] = {0, 0, 0}, there[3];
      axis[ours_of[column]] = 1;
      turn(sample.pose.orientation, axis, there);
      for (int row = 0; row < 3; ++row) EXPECT_NEAR(there[ours_of[row]], r[row][column], 1e-12);
    }
  }
}

TEST(Chai3dBridge, TellsWhatTheDeviceBears) {
  Opened o;
  o.open();
  crumble_device_info info{};
  info.struct_size = sizeof info;
  ASSERT_EQ(crumble_device_get_info(o.handle, &info), CRUMBLE_OK);
  EXPECT_STREQ(info.name, "double script through CHAI3D");
  EXPECT_EQ(info.max_force, 2);
  EXPECT_EQ(info.max_torque, 0);  // it has no motors to turn the handle
  EXPECT_EQ(info.max_stiffness, 400);
  EXPECT_EQ(info.max_damping, 4);
  EXPECT_EQ(info.workspace_low[1], -0.075);
  EXPECT_EQ(info.workspace_high[2], 0.075);
  EXPECT_EQ(info.measured, unsigned{CRUMBLE_SENSES_POSITION} | CRUMBLE_SENSES_BUTTONS);
}

TEST(Chai3dBridge, TorquesGoOnlyToMotors) {
  for (const bool motors : {false, true}) {
    Opened o;
    o.device->m_specifications.m_actuatedRotation = motors;
    o.open();
    const double force[3] = {0, 0, 0}, torque[3] = {0.01, 0.02, 0.03};
    ASSERT_EQ(crumble_device_write(o.handle, force, torque), CRUMBLE_OK);
    EXPECT_EQ(o.last().torque[0], motors ? 0.03 : 0);
    EXPECT_EQ(o.last().torque[1], motors ? 0.01 : 0);
    EXPECT_EQ(o.last().torque[2], motors ? 0.02 : 0);
  }
}

class Pressed : public ::testing::Test {
 protected:
  void SetUp() override {
    opened_.open();
    crumble_mesh cube;
    crumble_tool_def stick;
    ASSERT_EQ(crumble_mesh_create_paper(CRUMBLE_PAPER_CUBE, &cube), CRUMBLE_OK);
    ASSERT_EQ(crumble_sim_create(cube, nullptr, &sim_), CRUMBLE_OK);
    ASSERT_EQ(crumble_mesh_destroy(cube), CRUMBLE_OK);
    ASSERT_EQ(crumble_sim_fix_below(sim_, 1e-6), CRUMBLE_OK);
    ASSERT_EQ(crumble_tool_def_init(&stick, sizeof stick), CRUMBLE_OK);
    ASSERT_EQ(crumble_sim_add_tool(sim_, &stick, nullptr), CRUMBLE_OK);
    crumble_loop_def def;
    crumble_hand_def hand;
    ASSERT_EQ(crumble_loop_def_init(&def, sizeof def), CRUMBLE_OK);
    ASSERT_EQ(crumble_hand_def_init(&hand, sizeof hand), CRUMBLE_OK);
    def.driver = CRUMBLE_DRIVER_HOST;
    hand.device = opened_.handle;
    hand.workspace.position[1] = 0.04;
    ASSERT_EQ(crumble_loop_create(sim_, &def, &hand, 1, &loop_), CRUMBLE_OK) << crumble_last_error();
    felt_.struct_size = sizeof felt_;
  }
  void TearDown() override {
    EXPECT_EQ(crumble_loop_destroy(loop_), CRUMBLE_OK);
    EXPECT_EQ(crumble_sim_destroy(sim_), CRUMBLE_OK);
  }
  void tick(int times) {
    for (int i = 0; i < times; ++i) ASSERT_EQ(crumble_loop_tick(loop_), CRUMBLE_OK);
    ASSERT_EQ(crumble_loop_get_hand(loop_, 0, &felt_), CRUMBLE_OK);
  }

  Opened opened_;
  crumble_sim sim_ = nullptr;
  crumble_loop loop_ = nullptr;
  crumble_hand_status felt_{};
};

TEST_F(Pressed, TheDeviceIsPushedUp) {
  tick(1900);
  EXPECT_EQ(felt_.fault, unsigned{CRUMBLE_FAULT_NONE});
  const auto& sent = opened_.last();
  EXPECT_GT(sent.force[2], 0.3);  // CHAI3D's z: up
  EXPECT_LT(std::hypot(sent.force[0], sent.force[1]), 0.5 * sent.force[2]);
  EXPECT_EQ(sent.force[2], felt_.force[1]);
  for (const auto& any : opened_.device->sent) {
    EXPECT_LE(std::hypot(std::hypot(any.force[0], any.force[1]), any.force[2]), 2 + 1e-12);
  }
}

TEST_F(Pressed, ADeviceThatAnswersFalseIsLost) {
  tick(1900);
  opened_.device->works = false;
  tick(1);
  EXPECT_EQ(felt_.fault, unsigned{CRUMBLE_FAULT_DEVICE_LOST});
  EXPECT_EQ(felt_.callback_error, CRUMBLE_E_IO);
  for (const double f : opened_.last().force) EXPECT_EQ(f, 0);
}

TEST_F(Pressed, StoppingSendsZero) {
  tick(1900);
  ASSERT_NE(opened_.last().force[2], 0);
  ASSERT_EQ(crumble_loop_stop(loop_), CRUMBLE_OK);
  for (const double f : opened_.last().force) EXPECT_EQ(f, 0);
}

}  // namespace
