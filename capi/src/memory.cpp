// Where memory comes from, as C says it.
#include "crumble/base/memory.hpp"

#include <mutex>
#include <optional>

#include "crumble/base/memory_block.hpp"
#include "defs.hpp"

namespace crumble::capi {
namespace {

// The host's source or block. No object is alive when either changes, so nobody is in them.
constinit std::mutex setting;
constinit crumble_memory_source host{};
std::optional<MemoryBlock> block;

void* take(std::size_t bytes, std::size_t alignment, void*) {
  return host.take(bytes, alignment, host.user);
}

void give_back(void* memory, std::size_t bytes, std::size_t alignment, void*) {
  host.give_back(memory, bytes, alignment, host.user);
}

void set_host(const crumble_memory_source& given) {
  require_pointer("source.take", reinterpret_cast<const void*>(given.take));
  require_pointer("source.give_back", reinterpret_cast<const void*>(given.give_back));
  require_at_most("source.reserved", given.reserved, 0);
  set_memory_source({});  // throws while anything is taken: then nothing has changed
  host = given;
  set_memory_source({take, give_back, nullptr});
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_memory_set_source(const crumble_memory_source* source) {
  return guard(__func__, [&](const Call&) {
    const std::lock_guard lock(setting);
    if (source) {
      set_host(read_def("source", source, crumble_memory_source{}));
    } else {
      set_memory_source({});
    }
    block.reset();
    return CRUMBLE_OK;
  });
}

crumble_result crumble_memory_use_block(void* memory, uint64_t bytes) {
  return guard(__func__, [&](const Call&) {
    const std::lock_guard lock(setting);
    require_pointer("memory", memory);
    MemoryBlock::check_size(bytes);
    set_memory_source({});
    block.emplace(memory, static_cast<std::size_t>(bytes));
    set_memory_source(block->source());
    return CRUMBLE_OK;
  });
}

crumble_result crumble_memory_get_info(crumble_memory_info* info) {
  return guard(__func__, [&](const Call&) {
    const MemoryUse use = memory_use();
    crumble_memory_info out{};
    out.blocks = use.blocks, out.bytes = use.bytes, out.most_bytes = use.most_bytes;
    const std::lock_guard lock(setting);
    if (block) out.longest_free = block->longest_free();
    write_struct("info", info, out);
    return CRUMBLE_OK;
  });
}
