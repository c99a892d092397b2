// SPDX-License-Identifier: Apache-2.0
#include <cchip/blocks/traversal_events.hpp>

namespace cchip::model {

bool bad_descriptor(const std::array<std::uint32_t, 16>& query) {
  bool bad = (query[14] >> 30) != 0 || query[0] > last_base || query[1] > last_base;
  for (std::size_t i = 2; i < 11; ++i) {
    const auto m = static_cast<std::int32_t>(query[i]);
    bad = bad || m > (1 << 30) || m < -(1 << 30);
  }
  return bad;
}

/// Which sources may enter a clock later.
TraversalEvents::May TraversalEvents::ask(const Inputs& in) const {
  const auto free = [this](std::size_t context) { return !has(locked_, context); };
  const auto outside = [this](std::size_t context) { return !has(inside_, context); };
  const bool can_go = places_.m_valid() && room_ != 0;
  May may;
  may.verdict = verdict_ && free(in.lookup.context);
  may.result = results_.m_valid() && free(results_.m_data().context);
  may.drop = in.drop && free(in.drop->context);
  may.start = query_valid_ && judged_ && !starting_ && idle_context_ && outside(*idle_context_) && can_go &&
              answers_ < shape_.answers && in.start_ready;
  may.pop = want_context_ && outside(*want_context_) && can_go;
  return may;
}

TraversalEvents::Source TraversalEvents::choose() const {
  if (may_.result && result_first_) return Source::result;
  if (may_.verdict) return Source::verdict;
  if (may_.result) return Source::result;
  if (may_.drop) return Source::drop;
  if (may_.start) return Source::start;
  if (may_.pop) return Source::pop;
  return Source::none;
}

void TraversalEvents::clock(const Inputs& in) {
  const Source source = choose();
  result_first_ = result_first_ ? source != Source::result : source == Source::verdict && may_.result;
  const bool start = source == Source::start;
  const bool goes = start || source == Source::pop;
  const bool takes_room = goes || (source == Source::verdict && some_room_);
  std::optional<Event> event;
  if (source != Source::none) {
    event = Event();  // clang 14 does not take emplace() here
    if (goes) event->place = places_.m_number();
  }
  switch (source) {
    case Source::none:
      break;
    case Source::verdict:
      event->event = TraversalEvent::verdict;
      event->context = in.lookup.context;
      event->epoch = in.lookup.epoch;
      event->extra = some_room_;
      event->place = verdict_->place;
      event->verdict = *verdict_;
      break;
    case Source::result:
      event->event = TraversalEvent::result;
      event->judge = true;
      event->context = results_.m_data().context;
      event->epoch = results_.m_data().epoch;
      event->result = results_.m_data();
      break;
    case Source::drop:
      event->event = TraversalEvent::result;
      event->context = in.drop->context;
      event->epoch = in.drop->epoch;
      break;
    case Source::start:
      event->event = TraversalEvent::start;
      event->context = *idle_context_;
      break;
    case Source::pop:
      event->event = TraversalEvent::pop;
      event->context = *pop_context_;
      break;
  }

  // what the next clock may choose from
  may_ = choose_ ? May{} : ask(in);
  pop_context_ = want_context_;
  some_room_ = room_ != 0;
  const bool idle_load = !idle_context_ && in.running && !starting_;
  if (idle_load) {
    idle_context_ = idle_.grant(free_idle_);
  } else if (start) {
    idle_context_.reset();
  }
  idle_.clock(free_idle_, idle_load);
  want_context_ = want_.grant(free_want_);
  want_.clock(free_want_, choose_);
  free_idle_ = without_query_ & ~inside_;
  free_want_ = wanting_ & ~inside_;
  choose_ = !choose_;

  const bool done = in.left && in.left->start;
  const bool ends = done && !in.left->cancel;
  const bool query_in = in.query && query_ready_;
  query_bad_ = bad_next_;
  bad_next_ = query_ && bad_descriptor(*query_);
  if (query_in) query_ = in.query;
  judged_ = judging_ && !done;
  judging_ = query_valid_ && !done;
  query_ready_ = query_valid_ ? ends : !query_in;
  query_valid_ = query_valid_ ? !ends : query_in;
  starting_ = start || (starting_ && !done);

  const bool lookup = !verdict_ || source == Source::verdict;
  if (lookup) verdict_ = verdicts_.m_valid() ? std::optional(verdicts_.m_data()) : std::nullopt;
  verdicts_.clock(in.verdict.has_value(), in.verdict.value_or(BoxVerdict{}), lookup);
  results_.clock(in.result.has_value(), in.result.value_or(TraversalResult{}), source == Source::result);
  places_.clock(goes, in.left ? in.left->place : std::nullopt);
  room_ += room_back_;
  room_ -= takes_room ? 1 : 0;
  room_back_ = (in.left ? in.left->room : 0) + (in.leaf_room ? 1 : 0);
  few_ = answers_ < 4;
  answers_ += ends ? 1 : 0;
  answers_ -= in.answer_room ? 1 : 0;

  if (in.left) {
    const std::uint32_t bit = std::uint32_t{1} << in.left->context;
    inside_ &= ~bit;
    if (!in.left->active) free_idle_ |= bit;
    if (in.left->wants) free_want_ |= bit;
    without_query_ = in.left->active ? without_query_ & ~bit : without_query_ | bit;
    wanting_ = in.left->wants ? wanting_ | bit : wanting_ & ~bit;
  }
  if (in.leaving) locked_ &= ~(std::uint32_t{1} << *in.leaving);
  if (event) {
    locked_ |= std::uint32_t{1} << event->context;
    inside_ |= std::uint32_t{1} << event->context;
  }
  event_ = event;
}

void TraversalEvents::reset() {
  idle_.reset();
  want_.reset();
  verdicts_.reset();
  verdict_.reset();
  results_.reset();
  places_.reset();
  room_ = shape_.leaf_depth;
  room_back_ = 0;
  some_room_ = true;
  answers_ = 0;
  few_ = true;
  may_ = {};
  choose_ = false;
  // without_query_ and wanting_ as they are during reset
  free_idle_ = free_want_ = 0;
  locked_ = inside_ = wanting_ = 0;
  without_query_ = 0xffffffff;
  query_ready_ = query_valid_ = judging_ = judged_ = starting_ = result_first_ = false;
  idle_context_.reset();
  want_context_.reset();
  pop_context_.reset();
  event_.reset();
}

}  // namespace cchip::model
