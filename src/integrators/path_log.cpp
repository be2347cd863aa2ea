#include "integrators/path_log.h"

#include <algorithm>

namespace gradslc {
namespace {

Part largest_part(const PartValues& brought) {
  const auto largest = std::max_element(brought.values.begin(), brought.values.end(),
                                        [](Rgb a, Rgb b) { return luminance(a) < luminance(b); });
  return static_cast<Part>(largest - brought.values.begin());
}

}  // namespace

void PathLog::start(std::uint32_t pass, bool keeps_entries) {
  sample_ = DebugSample{.pass = pass};
  keeps_entries_ = keeps_entries;
  gather_throughput_ = Rgb(1), scale_ = 1;
  entries_.clear();
  vertex_throughput_.reset();
}

void PathLog::note(const Happening& what) { add_entry(what, Rgb(), std::nullopt); }

void PathLog::begin_gather(Rgb throughput) {
  gather_throughput_ = throughput;
  note(happening::Gather{throughput});
}

void PathLog::begin_next_events(float scale) { scale_ = scale; }

void PathLog::begin_compensation_ray(std::uint32_t index, float scale) {
  scale_ = scale;
  vertex_throughput_.reset();
  note(happening::CompensationRay{index, scale});
}

void PathLog::begin_vertex_gather(Rgb throughput) {
  vertex_throughput_ = throughput;
  note(happening::Gather{throughput});
}

void PathLog::end_compensation_rays() {
  scale_ = 1;
  vertex_throughput_.reset();
  note(happening::CompensationEnd{});
}

void PathLog::add(const Happening& what, const PartValues& brought, bool by_parts) {
  const Rgb value = brought.total() * scale_;
  if (by_parts && !is_black(value))
    add_entry(what, value, largest_part(brought));
  else
    add_entry(what, value, std::nullopt);
}

void PathLog::add_vpl(const happening::VplConnection& connection) {
  const Rgb throughput = vertex_throughput_.value_or(gather_throughput_) * scale_;
  const Part part = vertex_throughput_ ? Part::compensation : connection.vertex == 0 ? Part::direct : Part::vpl;
  add_entry(connection, throughput * connection.unshadowed * connection.transmittance * connection.weight, part);
}

void PathLog::add_selection(float cut_size, float node_evaluations) {
  sample_.cut_size += cut_size, sample_.node_evaluations += node_evaluations;
}

void PathLog::append(const PathLog& other, float scale) {
  const DebugSample& added = other.sample_;
  sample_.rays += added.rays;
  add_selection(added.cut_size * scale, added.node_evaluations);
  Largest contribution = added.contribution;
  contribution.luminance *= scale;
  sample_.contribution.raise(contribution);
  for (Entry entry : other.entries_) {
    entry.value *= scale;
    entries_.push_back(entry);
  }
}

void PathLog::add_entry(const Happening& what, Rgb value, std::optional<Part> part) {
  sample_.contribution.raise({luminance(value), sample_.pass, part});
  if (keeps_entries_) entries_.push_back({what, value, part});
}

}  // namespace gradslc
