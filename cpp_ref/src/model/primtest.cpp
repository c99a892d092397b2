// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/model/primtest.hpp>

namespace cchip::model {

AxisController::AxisController(const Options& options, std::size_t contexts)
    : options_(options),
      contexts_(contexts),
      free_(contexts),
      start_(contexts),
      ready_(contexts),
      side_(contexts),
      programme_(static_cast<std::size_t>(defs::programme_latency() - 1)) {}

std::size_t AxisController::load_context() const { return hand_out_.m_valid() ? hand_out_.m_data() : 0; }

void AxisController::clock(const std::optional<PairHeader>& pair, const std::optional<ReturnedBeat>& verdict) {
  // the context of a result is free after it
  const bool leaves = result_.has_value();
  const std::size_t leaving = leaving_;

  // what follows the verdict
  std::optional<Beat> proceeding;
  result_.reset();
  if (const auto& returned = programme_.q()) {
    const std::size_t context = returned->beat.context;
    const PairHeader& header = side_.at(context);
    const Step step = advance(options_, returned->beat.state, returned->verdict, header.err, found_);
    if (step.next) proceeding = Beat{context, *step.next};
    if (const auto& o = step.outcome) {
      result_ = o->result(header.tag);
      leaving_ = context;
    }
  }
  programme_.clock(verdict);

  // the next beat: the present EXHAUSTIVE pair; otherwise pairs that start and pairs that continue alternate
  const auto following = beat_ ? following_beat(options_, beat_->state) : std::nullopt;
  const bool take_start = start_.m_valid() && (!ready_.m_valid() || !started_);
  const bool ready_pop = !following && !take_start;
  const bool start_pop = !following && take_start;
  if (!following) started_ = take_start;
  if (following) {
    beat_->state = *following;
  } else if (take_start) {
    const Start& start = start_.m_data();
    beat_ = Beat{start.context, first_state(options_, start.mode, side_.at(start.context).err)};
  } else if (ready_.m_valid()) {
    beat_ = ready_.m_data();
  } else {
    beat_.reset();
  }

  // queues and contexts
  const std::size_t context = load_context();
  if (pair) side_.at(context) = *pair;
  ready_.clock(next_.has_value(), next_.value_or(Beat{}), ready_pop);
  start_.clock(load_.has_value(), load_.value_or(Start{}), start_pop);
  load_ = pair ? std::optional(Start{context, pair->mode}) : std::nullopt;
  const bool fresh_left = fresh_ != contexts_;
  const bool hands = hand_out_.s_ready();
  const std::size_t freed = free_.m_valid() ? free_.m_data() : 0;
  hand_out_.clock(fresh_left || free_.m_valid(), fresh_left ? fresh_ : freed, pair.has_value());
  free_.clock(leaves, leaving, hands && !fresh_left);
  if (hands && fresh_left) ++fresh_;
  next_ = std::move(proceeding);
}

void AxisController::reset() {
  fresh_ = 0;
  free_.reset();
  hand_out_.reset();
  start_.reset();
  load_.reset();
  ready_.reset();
  next_.reset();
  programme_.reset();
  started_ = false;
  beat_.reset();
  result_.reset();
}

Primtest::Primtest(const Parameters& parameters)
    : parameters_(parameters),
      operands_(static_cast<std::size_t>(parameters.contexts)),
      controller_(parameters.options, static_cast<std::size_t>(parameters.contexts)),
      pipeline_(static_cast<std::size_t>(defs::pipe_latency(parameters.substages))),
      results_(static_cast<std::size_t>(parameters.contexts)) {}

void Primtest::clock(const std::optional<PairRequest>& pair, bool m_result_ready) {
  const bool accept = pair && ready_;
  const bool answer = m_result_ready && results_.m_valid();

  results_.clock(controller_.result().has_value(), controller_.result().value_or(PairResult{}), m_result_ready);

  std::optional<ReturnedBeat> entering;
  if (const auto& beat = controller_.beat()) {
    const Operands& o = operands_.at(beat->context);
    entering = ReturnedBeat{
        *beat, sat_pipeline(parameters_.options.shape, beat_of(beat->state, o.err), o.a, o.b, parameters_.coord_w)};
  }
  if (accept) operands_.at(controller_.load_context()) = {pair->pair.a, pair->pair.b, pair->pair.eta};
  controller_.clock(accept ? std::optional<PairHeader>({pair->tag, pair->mode, pair->pair.eta}) : std::nullopt,
                    pipeline_.q());
  pipeline_.clock(std::move(entering));

  pairs_ = pairs_ + (accept ? 1 : 0) - (answer ? 1 : 0);
  ready_ = awake_ && pairs_ != static_cast<std::size_t>(parameters_.contexts);
  awake_ = true;
  idle_ = pairs_ == 0;
}

void Primtest::reset() {
  pairs_ = 0;
  ready_ = false;
  awake_ = false;
  idle_ = true;
  controller_.reset();
  pipeline_.reset();
  results_.reset();
}

}  // namespace cchip::model
