// SPDX-License-Identifier: Apache-2.0
#include <cchip/blocks/cache_fill.hpp>

namespace cchip::model {

CacheFill::CacheFill(std::size_t slots, std::size_t beats)
    : beats_(beats), lines_(slots), free_(slots), arrived_(slots), serve_queue_(slots) {}

std::optional<CacheFill::Fill> CacheFill::fill(bool free) const {
  if (!arrived_.m_valid() || !free) return std::nullopt;
  Fill fill = arrived_.m_data();
  fill.frame = lines_[fill.slot].frame;
  return fill;
}

void CacheFill::clock(const Inputs& in) {
  const bool release = serves_ && !collect_ && !collected_ && !serving_;
  const bool lost = release && (serves_->code == ReadCode::timeout || serves_->code == ReadCode::owed);
  const std::optional<std::size_t> back = next_free(release, lost, in.outstanding);
  clock_slots(in, release, lost);
  clock_serves(in, release);
  arrived_.clock(in.beat && in.beat->last, in.beat ? Fill{in.beat->slot, in.beat->code, 0} : Fill{}, in.free);
  free_.clock(in.free_take, back);
}

void CacheFill::reset() {
  lines_.assign(lines_.size(), Line{});
  free_.reset();
  arrived_.reset();
  serve_queue_.reset();
  serves_.reset();
  filled_.reset();
  collect_ = collected_ = serving_ = exhausted_ = false;
  lost_.clear();
  back_.reset();
  scan_ = 0;
}

/// The slot that goes back to the pool: the one that has been served, else one that was lost.
std::optional<std::size_t> CacheFill::next_free(bool release, bool lost, const std::vector<bool>& outstanding) {
  exhausted_ = lost_.size() == lines_.size();
  std::optional<std::size_t> back;
  if (release && !lost) back = serves_->slot;
  if (back_) {
    if (!back) back.swap(back_);
    return back;
  }
  if (lost_.count(scan_) != 0 && !outstanding[scan_]) {
    lost_.erase(scan_);
    back_ = scan_;
  }
  scan_ = (scan_ + 1) % lines_.size();
  return back;
}

void CacheFill::clock_slots(const Inputs& in, bool release, bool lost) {
  if (release) lines_[serves_->slot].held = false;
  if (lost) lost_.insert(serves_->slot);
  if (in.filled && in.filled->code == ReadCode::ok) lines_[in.filled->slot].filled = true;
  if (in.allocate) {
    Line& line = lines_[in.allocate->slot];
    line.held = true;
    line.filled = false;
    line.frame = in.allocate->frame;
  }
  if (in.beat && in.beat->beat) {
    const std::size_t words = 16 / beats_;
    LineData& data = lines_[in.beat->slot].data;
    for (std::size_t w = 0; w < words; ++w) data[*in.beat->beat * words + w] = in.beat->data[w];
  }
}

void CacheFill::clock_serves(const Inputs& in, bool release) {
  if (release) serves_.reset();
  const bool take = !serves_;
  const bool next = take && serve_queue_.m_valid();
  if (next) serves_ = serve_queue_.m_data();
  collected_ = collect_;
  collect_ = next;
  serving_ = in.serving;
  serve_queue_.clock(filled_.has_value(), filled_.value_or(Fill{}), take);
  filled_ = in.filled;
}

}  // namespace cchip::model
