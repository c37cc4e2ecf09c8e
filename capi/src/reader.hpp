// What a reader's handle stands for.
#pragma once

#include <atomic>
#include <memory>

#include "crumble/base/memory.hpp"
#include "crumble/crumble.h"
#include "crumble/fracture/fragments.hpp"
#include "crumble/fracture/surface.hpp"
#include "crumble/sim/publisher.hpp"
#include "handles.hpp"

namespace crumble::capi {

/// Between a simulation and one of its readers; both own it, so either may go first.
struct ReaderLink {
  explicit ReaderLink(const Simulation& sim) : publisher(sim) {}

  StatePublisher publisher;
  std::atomic<bool> is_open{true};  // the reader has not been destroyed
};

struct Reader : Allocated {
  using Handle = crumble_reader;
  static constexpr const char* kName = "reader";
  static HandleTable table;

  Reader(std::shared_ptr<const TetMesh> body, const Simulation& simulation, const SurfaceSettings& settings);
  ~Reader() { link->is_open = false; }

  void update() noexcept;
  const Fragment& measure(std::uint32_t fragment) noexcept;
  std::span<const std::uint32_t> list(std::uint32_t fragment, std::uint32_t which) noexcept;

  std::shared_ptr<const TetMesh> mesh;
  std::shared_ptr<ReaderLink> link;
  const PublishedState* state;
  SurfaceExtractor surface;

 private:
  void list_triangles() noexcept;

  Vector<double> masses_;  // of the nodes, kg
  Vector<Fragment> fragments_;
  FragmentLists lists_;
  Vector<std::uint32_t> triangles_, first_triangles_;  // of the surface by fragment, and where each one's begin
  bool measured_ = false, listed_ = false, triangles_listed_ = false;
};

}  // namespace crumble::capi
