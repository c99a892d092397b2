// SPDX-License-Identifier: Apache-2.0
#include <cchip/model/primtest.hpp>

namespace cchip::model {
namespace {

const AxisCode first_code{AxisClass::normal_a, 0, 0};
const AxisCode illegal_code{AxisClass::illegal, 0, 0};

bool is_last(const AxisCode& code) {
  return code == illegal_code || code == exhaustive_axis(defs::exhaustive_beats_tri_tri - 1);
}

AxisCode next(const AxisCode& code) {
  for (int beat = 0; beat + 1 < defs::exhaustive_beats_tri_tri; ++beat) {
    if (exhaustive_axis(beat) == code) return exhaustive_axis(beat + 1);
  }
  throw std::logic_error("model::AxisController: no axis follows " + to_words(code));
}

}  // namespace

AxisController::AxisController(std::size_t contexts)
    : contexts_(contexts), free_(contexts), start_(contexts), side_(contexts) {}

std::size_t AxisController::load_context() const {
  if (fresh_ != contexts_) return fresh_;
  return free_.m_valid() ? free_.m_data() : 0;
}

void AxisController::clock(const std::optional<PairHeader>& pair, const std::optional<ReturnedBeat>& verdict) {
  const bool last = verdict && is_last(verdict->beat.code);

  // result of the pair whose last verdict is here
  result_.reset();
  if (verdict) {
    const AxisCode& code = verdict->beat.code;
    if (code == first_code) {
      separated_ = false;
      special_ = false;
      witness_ = {};
    }
    if (code == illegal_code) {
      separated_ = true;
    } else if (verdict->verdict.separated && !separated_) {
      separated_ = true;
      witness_ = code;
    }
    const bool normal = code.cls == AxisClass::normal_a || code.cls == AxisClass::normal_b;
    const auto& zero = verdict->verdict.zero;
    special_ = special_ || (normal && verdict->verdict.axis_zero) ||
               (code.cls == AxisClass::normal_a && zero[0] && zero[1] && zero[2]);
    if (last) {
      const PairHeader& header = side_.at(verdict->beat.context);
      Result r;
      r.tag = header.tag;
      if (code == illegal_code) {
        r.grid = true;
        r.axis = illegal_code;
      } else {
        r.grid = !separated_;
        r.definite = header.err == 0 && !(special_ && r.grid);
        r.axis = witness_;
        r.beats = defs::exhaustive_beats_tri_tri;
      }
      r.hit = r.grid || !r.definite;
      result_ = r;
    }
  }

  // next beat
  const bool start_ready = !beat_ || is_last(beat_->code);
  if (!start_ready) {
    beat_->code = next(beat_->code);
  } else if (start_.m_valid()) {
    beat_ = Beat{start_.m_data().context, start_.m_data().legal ? first_code : illegal_code};
  } else {
    beat_.reset();
  }

  // contexts
  const std::size_t context = load_context();
  const bool fresh_left = fresh_ != contexts_;
  if (pair) side_.at(context) = *pair;
  start_.clock(pair.has_value(),
               {context, pair && pair->mode == static_cast<int>(PairMode::exhaustive)}, start_ready);
  free_.clock(last, verdict ? verdict->beat.context : 0, pair && !fresh_left);
  if (pair && fresh_left) ++fresh_;
}

void AxisController::reset() {
  fresh_ = 0;
  free_.reset();
  start_.reset();
  beat_.reset();
  result_.reset();
}

PrimtestTriTri::PrimtestTriTri(const Parameters& parameters)
    : parameters_(parameters),
      operands_(static_cast<std::size_t>(parameters.contexts)),
      controller_(static_cast<std::size_t>(parameters.contexts)),
      pipeline_(static_cast<std::size_t>(1 + defs::pipe_latency(parameters.substages))),
      results_(static_cast<std::size_t>(parameters.contexts)) {}

void PrimtestTriTri::clock(const std::optional<PairIn>& pair, bool m_result_ready) {
  const bool accept = pair && ready_;
  const bool answer = m_result_ready && out_.m_valid();

  const bool pop = out_.s_ready();
  out_.clock(results_.m_valid(), results_.m_valid() ? results_.m_data() : Result{}, m_result_ready);
  results_.clock(controller_.result().has_value(), controller_.result().value_or(Result{}), pop);

  std::optional<ReturnedBeat> entering;
  if (const auto& beat = controller_.beat()) {
    const Operands& o = operands_.at(beat->context);
    entering = ReturnedBeat{*beat, sat_pipeline(beat->code, o.a, o.b, parameters_.coord_w)};
  }
  if (load_) operands_.at(controller_.load_context()) = {load_->a, load_->b};
  controller_.clock(load_ ? std::optional<PairHeader>(load_->header) : std::nullopt, pipeline_.q());
  pipeline_.clock(std::move(entering));

  load_ = accept ? pair : std::nullopt;
  pairs_ = pairs_ + (accept ? 1 : 0) - (answer ? 1 : 0);
  ready_ = pairs_ != static_cast<std::size_t>(parameters_.contexts);
  idle_ = pairs_ == 0;
}

void PrimtestTriTri::reset() {
  pairs_ = 0;
  ready_ = false;
  idle_ = true;
  load_.reset();
  controller_.reset();
  pipeline_.reset();
  results_.reset();
  out_.reset();
}

}  // namespace cchip::model
