#include <algorithm>
#include <numeric>

#include "crumble/base/memory.hpp"
#include "network/layout.hpp"

namespace crumble {
namespace {

// Numbers the steps of `value` along `order`, which is sorted by it: a new one begins where it has risen by `height`
// since the step began.
void number_steps(std::span<const std::uint32_t> order, std::span<const double> value, double height,
                  Vector<std::uint32_t>& step_of) {
  std::uint32_t step = 0;
  double begin = value[order[0]];
  for (const std::uint32_t node : order) {
    if (value[node] - begin > height) ++step, begin = value[node];
    step_of[node] = step;
  }
}

Vector<double> component(std::span<const Vec3> positions, int axis) {
  Vector<double> values;
  values.reserve(positions.size());
  for (const Vec3& p : positions) values.push_back(p[axis]);
  return values;
}

}  // namespace

Vector<std::uint32_t> row_order(const SpringNetwork& network, std::span<const Vec3> positions) {
  double length = 0;
  for (const double l : network.rest_lengths) length += l;
  const double height = 0.6 * length / static_cast<double>(network.spring_count());

  const Vector<double> x = component(positions, 0), y = component(positions, 1), z = component(positions, 2);
  Vector<std::uint32_t> order(positions.size()), layer(positions.size()), row(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, [&](auto a, auto b) { return y[a] < y[b]; });
  number_steps(order, y, height, layer);
  for (auto begin = order.begin(); begin != order.end();) {
    const auto end = std::find_if(begin, order.end(), [&](auto node) { return layer[node] != layer[*begin]; });
    std::stable_sort(begin, end, [&](auto a, auto b) { return z[a] < z[b]; });
    number_steps({&*begin, static_cast<std::size_t>(end - begin)}, z, height, row);
    std::stable_sort(begin, end, [&](auto a, auto b) { return row[a] != row[b] ? row[a] < row[b] : x[a] < x[b]; });
    begin = end;
  }
  return order;
}

}  // namespace crumble
