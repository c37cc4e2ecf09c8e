// The tracker's state as bytes and as a hash.
#include <algorithm>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/fracture/fragment_tracker.hpp"
#include "fragment_graph.hpp"

namespace crumble {
namespace {

void require(bool good, const char* what) {
  if (!good) throw Error(Code::corrupt, std::string("snapshot holds impossible fragments: ") + what);
}

void add(Hash& hash, std::span<const std::uint32_t> words) noexcept {
  hash.add({reinterpret_cast<const std::uint8_t*>(words.data()), words.size_bytes()});
}

}  // namespace

void FragmentTracker::add_to(Hash& hash) const noexcept {
  add(hash, log_);
  add(hash, labels_);
  for (const FragmentRecord& record : records_) {
    hash.add(std::uint64_t{record.parent} << 32 | record.node_count);
    hash.add(record.born);
  }
  hash.add(std::uint64_t{settled_end_});
  hash.add(std::uint64_t{search_end_});
  hash.add(std::uint64_t{expanded_});
}

void FragmentTracker::save(ByteWriter& out) const {
  out.put(log_);
  out.put(std::uint64_t{settled_end_});
  out.put(std::uint64_t{search_end_});
  out.put(expanded_);
  out.put(std::uint64_t{records_.size()});
  for (const FragmentRecord& r : records_) out.put(r.parent), out.put(r.node_count), out.put(r.born);
  out.put(labels_);
}

void FragmentTracker::load(ByteReader& in) {
  FragmentTracker next = *this;
  next.reset();
  next.load_log(in);
  const auto search_end = in.get<std::uint64_t>();
  const auto expanded = in.get<std::uint32_t>();
  next.load_records(in);
  next.load_labels(in);
  next.resume_search(search_end, expanded);
  *this = std::move(next);
}

void FragmentTracker::load_log(ByteReader& in) {
  for (const std::uint32_t spring : in.get_vector<std::uint32_t>()) {
    require(spring < cut_.size() && !cut_[spring], "a cut");
    note_cut(spring);
  }
  const auto end = in.get<std::uint64_t>();
  require(end <= log_.size(), "the number of settled cuts");
  settled_end_ = static_cast<std::size_t>(end);
  for (std::size_t i = 0; i < settled_end_; ++i) gone_[log_[i]] = true;
}

// What was there from the start has no parent; all others come after theirs.
void FragmentTracker::load_records(ByteReader& in) {
  records_.clear();
  const std::size_t first_count = graph_->part_sizes.size();
  const auto count = in.get<std::uint64_t>();
  require(count >= first_count && count <= labels_.size(), "their count");
  for (std::uint64_t id = 0; id < count; ++id) {
    FragmentRecord r;
    r.parent = in.get<std::uint32_t>(), r.node_count = in.get<std::uint32_t>(), r.born = in.get<std::uint64_t>();
    require(id < first_count ? r.parent == kNoFragment : r.parent < id, "a parent");
    require(r.born >= (id < first_count || records_.empty() ? 0 : records_.back().born), "a step of birth");
    require(id >= first_count || r.born == 0, "a step of birth");
    records_.push_back(r);
  }
}

// The labels must be the parts of the body as the settled cuts have left it, each with its own id or removed.
void FragmentTracker::load_labels(ByteReader& in) {
  const Vector<std::uint32_t> labels = in.get_vector<std::uint32_t>();
  require(labels.size() == labels_.size(), "the number of labels");
  Vector<std::uint8_t> intact(gone_.size());
  for (std::size_t s = 0; s < intact.size(); ++s) intact[s] = !gone_[s];
  FragmentLabeler parts(labels.size(), graph_->springs);
  Vector<std::uint32_t> ids(parts.label(intact)), node_counts(records_.size());
  std::size_t known = 0, removed = 0;  // parts
  for (std::size_t node = 0; node < labels.size(); ++node) {
    const std::uint32_t part = parts.labels()[node], id = labels[node];
    require(id == kNoFragment || id < records_.size(), "a label");
    if (part == known) {  // a part's first node
      ++known;
      ids[part] = id;
      require(id == kNoFragment || node_counts[id] == 0, "two parts under one id");
      removed += id == kNoFragment;
    }
    require(ids[part] == id, "two ids in one part");
    if (id != kNoFragment) ++node_counts[id];
  }
  std::size_t empty = 0;  // fragments
  for (std::size_t id = 0; id < records_.size(); ++id) {
    require(records_[id].node_count == node_counts[id], "a node count");
    empty += node_counts[id] == 0;
  }
  require(empty <= removed && (empty > 0 || removed == 0), "the number of removed ones");
  std::copy(labels.begin(), labels.end(), labels_.begin());
}

void FragmentTracker::resume_search(std::uint64_t search_end, std::uint32_t expanded) {
  require(search_end >= settled_end_ && search_end <= log_.size(), "the end of the search");
  search_end_ = static_cast<std::size_t>(search_end);
  if (searching()) seed_search();
  require(expand(expanded) == expanded, "the length of the search");
}

}  // namespace crumble
