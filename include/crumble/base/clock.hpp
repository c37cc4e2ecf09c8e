// Time, in seconds.
#pragma once

namespace crumble {

/// Monotonic wall clock; no system call on Linux (vDSO), so a step may read it.
double wall_seconds() noexcept;
/// CPU time of the calling thread; a system call, so no step reads it.
double thread_cpu_seconds() noexcept;

}  // namespace crumble
