// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/traversal.hpp>

namespace cchip::model {

namespace {

LeafQueue::Children children(std::uint8_t kinds, std::uint32_t first) {
  LeafQueue::Children x;
  for (unsigned i = 0; i < 4; ++i) x.kinds[i] = kinds >> 2 * i & 3U;
  x.first = first;
  return x;
}

}  // namespace

Traversal::Traversal(const Shape& shape)
    : shape_(shape),
      events_({shape.queries, shape.pairs, shape.leaf_depth, 2 * shape.queries}),
      states_(shape.queries),
      constants_(shape.queries),
      works_(shape.queries),
      stacks_(shape.queries, std::vector<StackEntry>(shape.stack)),
      leaf_queue_(shape.queries, shape.leaf_depth, shape.credit),
      leaf_places_(shape.leaves, shape.pairs),
      done_(2 * shape.queries) {
  reset();
}

std::optional<Traversal::Start> Traversal::start() const {
  const auto& inside = inside_[leaving];
  if (!inside || inside->event.event != TraversalEvent::start || events_.query_bad()) return std::nullopt;
  const std::size_t context = inside->event.context;
  const unsigned epoch = states_[context].epoch;
  if (works_[context][epoch] != 0) return std::nullopt;
  return Start{context, epoch};
}

TraversalEvents::Inputs Traversal::events_inputs(const Inputs& in) const {
  TraversalEvents::Inputs x;
  x.running = cleared_ == 4 * shape_.queries;
  x.query = in.query;
  x.start_ready = in.start_ready;
  x.verdict = in.verdict;
  x.lookup = {in.lookup_context, in.lookup_pair.epoch};
  x.result = in.result;
  if (leaf_queue_.drop_valid()) x.drop = TraversalEvents::Of{leaf_queue_.pair().context, leaf_queue_.pair().epoch};
  if (inside_[leaving]) x.leaving = inside_[leaving]->event.context;
  if (decision_) {
    const TraversalEvents::Event& event = inside_[stages - 1]->event;
    TraversalEvents::Left left;
    left.context = event.context;
    left.active = decision_->state.active;
    left.wants = decision_->wants;
    left.start = event.event == TraversalEvent::start;
    left.cancel = decision_->cancelled;
    if (decision_->place_free) left.place = event.place;
    left.room = decision_->room;
    x.left = left;
  }
  x.leaf_room = leaf_queue_.room();
  x.answer_room = done_.m_valid() && in.done_ready;
  return x;
}

void Traversal::decide_next(const Inputs& in) {
  decision_.reset();
  judged_.reset();
  if (!inside_[stages - 1]) return;
  const Inside& inside = *inside_[stages - 1];
  const TraversalEvents::Event& event = inside.event;
  const std::size_t context = event.context;
  Occurrence o;
  o.event = event.event;
  o.state = states_[context];
  const bool own = event.event == TraversalEvent::start || event.event == TraversalEvent::pop;
  o.epoch = own ? o.state.epoch : event.epoch;
  o.live = o.state.active && o.epoch == o.state.epoch;
  o.extra = event.extra;
  o.over = inside.over;
  o.constants = constants_[context];
  o.work = works_[context][o.epoch];
  o.verdict = event.verdict;
  o.pair = inside.pair;
  o.lines = inside.lines;
  o.result = event.result;
  if (o.state.entries > 0 && o.state.entries <= shape_.stack) o.top = stacks_[context][o.state.entries - 1];
  if (const auto& query = events_.query()) {
    o.bad = events_.query_bad();
    o.mode = ((*query)[14] >> 28 & 1) != 0 ? QueryMode::all : QueryMode::first;
    o.query = {(*query)[0], (*query)[1], (*query)[15]};
  }
  TraversalLimits limits = in.limits;
  limits.pairs_each = pairs_each_;
  limits.open = inside.open_limit;
  limits.stack = shape_.stack;
  decision_ = decide(limits, o);
  if (event.judge) judged_ = Judgement{o.live, decision_->constants.tag};
}

void Traversal::clock(const Inputs& in) {
  const TraversalEvents::Inputs to_events = events_inputs(in);
  const bool running = to_events.running;
  const unsigned pairs_each = in.limits.pairs_each;
  const unsigned pairs_each_now = events_.few() ? std::min(2 * pairs_each + 1, 7U) : pairs_each;

  // what the event at the end of the pipeline brings about
  fetch_.reset();
  step_.reset();
  LeafQueue::Inputs to_leaves;
  bool ends = false;
  DoneRecord done;
  if (decision_) {
    const Decision& d = *decision_;
    const TraversalEvents::Event& event = inside_[stages - 1]->event;
    const std::size_t context = event.context;
    const bool own = event.event == TraversalEvent::start || event.event == TraversalEvent::pop;
    const unsigned epoch = own ? states_[context].epoch : event.epoch;
    to_leaves.epoch = LeafQueue::Epoch{context, d.state.epoch};
    if (d.leaf) {
      to_leaves.entry = LeafQueue::Entry{context, epoch, children(d.leaf->kinds_a, d.leaf->first_a),
                                         children(d.leaf->kinds_b, d.leaf->first_b), d.leaf->leaves};
    }
    if (d.goes) {
      fetch_ = Fetch{event.place,
                     context,
                     d.goes,
                     0,
                     0,
                     0,
                     d.constants.base_a + d.goes->line_a,
                     d.constants.base_b + d.goes->line_b};
    }
    step_ = d.step;
    if (d.done) {
      ends = true;
      done = *d.done;
    }
    if (d.push) stacks_[context][d.at] = *d.push;
    states_[context] = d.state;
    constants_[context] = d.constants;
    works_[context][epoch] = d.work;
  } else if (!running) {
    to_leaves.epoch = LeafQueue::Epoch{cleared_ % shape_.queries, 0};
  }
  const bool goes = fetch_.has_value();
  to_leaves.credit = in.credit;
  to_leaves.ready = leaf_places_.m_valid() && !goes;
  to_leaves.drop_ready = events_.drop_ready();
  const bool leaves = leaf_queue_.valid() && to_leaves.ready;
  if (leaves) {
    const LeafQueue::Pair& pair = leaf_queue_.pair();
    fetch_ = Fetch{leaf_places_.m_number(),
                   pair.context,
                   std::nullopt,
                   pair.epoch,
                   pair.kind_a,
                   pair.kind_b,
                   pair.line_a,
                   pair.line_b};
  }

  // the pipeline; what is looked up counts on the clock on which its verdict enters
  if (auto& third = inside_[1]) third->over = states_[third->event.context].steps >= in.limits.steps;
  if (auto& sixth = inside_[4]) sixth->open_limit = in.limits.open;
  const std::optional<TraversalEvents::Event> entered = events_.event();
  for (std::size_t i = stages - 1; i > 0; --i) inside_[i] = std::move(inside_[i - 1]);
  inside_[0].reset();
  if (entered) inside_[0] = Inside{*entered, looked_pair_, looked_lines_};
  looked_pair_ = in.lookup_pair;
  looked_lines_ = in.lookup_lines;

  leaf_places_.clock(leaves, in.leaf_left);
  leaf_queue_.clock(to_leaves);
  done_.clock(ends, done, in.done_ready);
  events_.clock(to_events);
  if (!running) ++cleared_;
  decide_next(in);
  pairs_each_ = pairs_each_now;
}

void Traversal::reset() {
  events_.reset();
  inside_ = {};
  decision_.reset();
  judged_.reset();
  for (QueryState& state : states_) state = QueryState{};
  for (auto& work : works_) work = {};
  cleared_ = 0;
  leaf_queue_.reset();
  leaf_places_.reset();
  done_.reset();
  fetch_.reset();
  step_.reset();
}

}  // namespace cchip::model
