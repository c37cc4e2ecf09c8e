#include "crumble/device/pose_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "crumble/base/memory.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

Trajectory from_rows(Vector<std::pair<double, Vec3>> rows) {
  Trajectory out;
  for (const auto& [time, position] : rows) out.rows.push_back({.time = time, .pose = {position, Quat::Identity()}});
  return out;
}

TEST(PoseCurve, PassesThroughEveryRowExactly) {
  const Trajectory motion = random_trajectory(1, 500);
  const PoseCurve curve(motion);
  for (std::size_t i = 0; i < motion.rows.size(); ++i) {
    const auto& row = motion.rows[i];
    const CurvePoint point = curve.at(row.time);
    EXPECT_EQ(curve.row_at(row.time), i);
    EXPECT_EQ(point.pose.position, row.pose.position) << i;
    for (int c = 0; c < 4; ++c) {
      EXPECT_NEAR(point.pose.orientation.coeffs()[c], row.pose.orientation.coeffs()[c], 1e-15) << i;
    }
  }
}

// Between two rows no component leaves the interval between them, and it does not turn inside: what keeps the tool from
// touching a body before the hand did.
TEST(PoseCurve, IsMonotoneBetweenRows) {
  const Trajectory motion = random_trajectory(2, 300);
  const PoseCurve curve(motion);
  for (std::size_t i = 0; i + 1 < motion.rows.size(); ++i) {
    const auto &a = motion.rows[i], &b = motion.rows[i + 1];
    Vec3 before = a.pose.position;
    double fraction = 0;
    for (int j = 1; j <= 60; ++j) {
      fraction += (1 - fraction) * 0.3;  // to within rounding of the next row
      const Vec3 p = curve.at(a.time + (b.time - a.time) * fraction).pose.position;
      for (int c = 0; c < 3; ++c) {
        const double from = a.pose.position[c], to = b.pose.position[c];
        EXPECT_GE(p[c], std::min(from, to));
        EXPECT_LE(p[c], std::max(from, to));
        EXPECT_GE((p[c] - before[c]) * (to - from), -1e-17) << i << ' ' << j;
      }
      before = p;
    }
  }
}

// The first and last rows have a neighbour on one side only; there too the curve must not start the wrong way.
TEST(PoseCurve, NeverMovesAgainstTheRowsNotEvenAtTheEnds) {
  Random random(7);
  for (int k = 0; k < 2000; ++k) {
    Vector<std::pair<double, Vec3>> rows;
    double time = 0;
    for (int i = 0; i < 3; ++i, time += random.uniform(0.001, 0.1)) rows.push_back({time, random_vec(random, 0.1)});
    if (k % 2) rows[1].second = rows[0].second + 0.01 * random_vec(random, 0.1);
    const PoseCurve curve(from_rows(rows));
    for (int i = 0; i < 2; ++i) {
      const Vec3 way = rows[i + 1].second - rows[i].second;
      for (int j = 0; j <= 20; ++j) {
        const double t = rows[i].first + (rows[i + 1].first - rows[i].first) * j / 20;
        for (int c = 0; c < 3; ++c) EXPECT_GE(curve.at(t).linear_velocity[c] * way[c], -1e-12) << k << ' ' << t;
      }
    }
  }
}

// Rows 1 s and 3 s apart, slopes 1 and 2 m/s: Fritsch and Butland give 3 (1 + 3) / (7 / 1 + 5 / 2) = 24 / 19 between
// them, the parabola through the three rows gives 1 - 1 / 4 and 2 + 3 / 4 at the ends.
TEST(PoseCurve, SlopesAtUnequalRowsByHand) {
  const PoseCurve curve(from_rows({{0, {0, 0, 0}}, {1, {1, 0, 0}}, {4, {7, 0, 0}}}));
  EXPECT_NEAR(curve.at(0).linear_velocity.x(), 0.75, 1e-15);
  EXPECT_NEAR(curve.at(1).linear_velocity.x(), 24.0 / 19, 1e-15);
  EXPECT_NEAR(curve.at(4).linear_velocity.x(), 2.75, 1e-15);
}

TEST(PoseCurve, AHandAtRestStaysAtRestToTheBit) {
  const Vec3 still(0.1, -0.065510712, 0.3), away(0.2, 0.1, 0.3);
  const PoseCurve curve(from_rows({{0, still}, {0.1, still}, {0.3, still}, {0.4, away}, {0.5, away}, {0.6, away}}));
  for (double t = 0; t <= 0.3; t += 0.001) {
    EXPECT_EQ(curve.at(t).pose.position, still) << t;
    EXPECT_EQ(curve.at(t).linear_velocity, Vec3(0, 0, 0)) << t;
  }
  EXPECT_EQ(curve.at(0.55).pose.position, away);
}

TEST(PoseCurve, VelocityIsContinuousAcrossRows) {
  const Trajectory motion = random_trajectory(3, 200);
  const PoseCurve curve(motion);
  for (std::size_t i = 1; i + 1 < motion.rows.size(); ++i) {
    const double t = motion.rows[i].time, eps = 1e-9;
    EXPECT_LT(norm(curve.at(t - eps).linear_velocity - curve.at(t + eps).linear_velocity), 1e-4) << i;
  }
}

TEST(PoseCurve, VelocitiesAreTheDerivatives) {
  const PoseCurve curve(random_trajectory(4, 100));
  Random random(5);
  for (int k = 0; k < 2000; ++k) {
    const double t = random.uniform(curve.first_time() + 1e-3, curve.last_time() - 1e-3), h = 1e-6;
    if (curve.row_at(t - h) != curve.row_at(t + h)) continue;
    const CurvePoint at = curve.at(t), before = curve.at(t - h), after = curve.at(t + h);
    EXPECT_LT(norm((after.pose.position - before.pose.position) / (2 * h) - at.linear_velocity), 1e-4) << t;
    // the small rotation from before to after, seen from outside: 2 vec(q1 q0*) is its angle times its axis
    const Quat& q0 = before.pose.orientation;
    const Quat turn = multiply(after.pose.orientation, Quat(q0.w(), -q0.x(), -q0.y(), -q0.z()));
    const double sign = turn.w() < 0 ? -1 : 1;
    const Vec3 omega = Vec3(turn.x(), turn.y(), turn.z()) * (sign / h);
    EXPECT_LT(norm(omega - at.angular_velocity), 1e-4 * (1 + norm(omega))) << t;
  }
}

TEST(PoseCurve, ReproducesAStraightLine) {
  const Vec3 start(0.1, 0.2, 0.3), velocity(0.05, -0.1, 0);
  Random random(6);
  Vector<std::pair<double, Vec3>> rows;
  for (double t = 0; t < 1; t += random.uniform(0.01, 0.1)) rows.push_back({t, start + t * velocity});
  for (const std::size_t count : {std::size_t{2}, std::size_t{3}, rows.size()}) {
    const PoseCurve curve(from_rows({rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(count)}));
    for (double t = 0; t <= curve.last_time(); t += 0.0007) {
      EXPECT_LT(norm(curve.at(t).pose.position - (start + t * velocity)), 1e-15) << t;
      EXPECT_LT(norm(curve.at(t).linear_velocity - velocity), 1e-13) << t;
    }
  }
}

// Against y = t^3 on a fine and a finer grid: the error of a monotone stretch falls as h^3 or faster.
TEST(PoseCurve, ConvergesOnASmoothMotion) {
  const auto worst = [](int n) {
    Vector<std::pair<double, Vec3>> rows;
    for (int i = 0; i <= n; ++i) {
      const double t = 1 + 1.0 * i / n;
      rows.push_back({t, {t * t * t, 0, 0}});
    }
    const PoseCurve curve(from_rows(rows));
    double error = 0;
    for (int i = 0; i <= 10 * n; ++i) {
      const double t = 1 + 0.1 * i / n;
      error = std::max(error, std::abs(curve.at(t).pose.position.x() - t * t * t));
    }
    return error;
  };
  const double coarse = worst(20), fine = worst(40);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_GT(coarse / fine, 7);
}

TEST(PoseCurve, TurnsTheShorterWayRound) {
  Trajectory motion = from_rows({{0, Vec3::Zero()}, {1, Vec3::Zero()}});
  const Quat q = axis_angle({0, 0, 1}, 0.2);
  motion.rows[1].pose.orientation = Quat(-q.w(), -q.x(), -q.y(), -q.z());  // the same turn, other sign
  const PoseCurve curve(motion);
  EXPECT_NEAR(std::abs(curve.at(0.5).pose.orientation.z()), std::sin(0.05), 1e-15);
  EXPECT_NEAR(curve.at(0.5).angular_velocity.z(), 0.2, 1e-3);
  EXPECT_LT(std::abs(curve.at(0.5).angular_velocity.x()), 1e-15);
}

TEST(PoseCurve, ClampsTimeToItsRows) {
  const PoseCurve curve(from_rows({{1, {0, 0, 0}}, {2, {1, 2, 3}}, {3, {2, 2, 3}}}));
  EXPECT_EQ(curve.at(-5).pose.position, Vec3(0, 0, 0));
  EXPECT_EQ(curve.at(99).pose.position, Vec3(2, 2, 3));
}

TEST(PoseCurve, RefusesTooFewOrImpossibleRows) {
  EXPECT_EQ(error_of([] { PoseCurve{Trajectory{}}; }).code(), Code::empty);
  EXPECT_EQ(error_of([] { PoseCurve{from_rows({{0, {0, 0, 0}}})}; }).code(), Code::empty);
  const auto fast = error_of([] { PoseCurve{from_rows({{0, {0, 0, 0}}, {1e-9, {1, 0, 0}}, {1, {1, 0, 0}}})}; });
  EXPECT_EQ(fast.code(), Code::out_of_range);
  EXPECT_TRUE(mentions(fast, "rows[1]")) << fast.what();
  EXPECT_EQ(error_of([] {
              PoseCurve{from_rows({{0, {-1e308, 0, 0}}, {1, {1e308, 0, 0}}})};
            }).code(),
            Code::out_of_range);
}

}  // namespace
}  // namespace crumble
