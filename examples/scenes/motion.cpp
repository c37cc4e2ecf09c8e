#include "scenes/scene.hpp"

namespace crumble {

MotionDevice open_motion(const Motion& motion, double tick) {
  if (!motion.path.empty()) {
    return {open_path({motion.start, motion.path}, tick), Workspace(), motion.path.back().time};
  }
  if (!motion.trajectory) {
    return {open_press(motion.press, tick), Workspace(), motion.press.depth / motion.press.speed};
  }
  const double first = motion.replay.from.value_or(motion.trajectory->rows.front().time);
  const double last = motion.replay.to.value_or(motion.trajectory->rows.back().time);
  return {open_replay(*motion.trajectory, motion.replay, tick), Workspace(motion.workspace), last - first};
}

}  // namespace crumble
