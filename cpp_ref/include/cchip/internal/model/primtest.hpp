// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact models of cchip_axis_controller and cchip_primtest (all shapes): they predict every output
/// on every clock.
#ifndef CCHIP_INTERNAL_MODEL_PRIMTEST_HPP
#define CCHIP_INTERNAL_MODEL_PRIMTEST_HPP

#include <cchip/internal/model/programme.hpp>
#include <cchip/internal/model/stream.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cstdint>
#include <optional>

namespace cchip::model {

/// The fields of the stream s_pair that the controller sees.
struct PairHeader {
  std::uint16_t tag = 0;
  PairMode mode = PairMode::exhaustive;  ///< reserved values included
  int err = 0;                           ///< eta, 0..15
};

/// A beat on its way through the pipeline, and the verdict that comes back for it.
struct Beat {
  std::size_t context = 0;
  State state;
};
struct ReturnedBeat {
  Beat beat;
  Verdict verdict;
};

/// cchip_axis_controller.
class AxisController {
 public:
  AxisController(const Options& options, std::size_t contexts);

  std::size_t load_context() const;
  /// m_beat_*; the axis it asks for is beat_of(beat()->state, eta).
  const std::optional<Beat>& beat() const { return beat_; }
  /// m_result_*
  const std::optional<PairResult>& result() const { return result_; }
  /// Internal net pair_waits.
  bool pair_waits() const { return start_.m_valid() || ready_.m_valid() || beat_.has_value(); }

  void clock(const std::optional<PairHeader>& pair, const std::optional<ReturnedBeat>& verdict);
  void reset();

 private:
  struct Start {
    std::size_t context = 0;
    PairMode mode = PairMode::exhaustive;
  };
  Options options_;
  std::size_t contexts_;
  std::size_t fresh_ = 0;
  Fifo<std::size_t> free_;
  SkidBuffer<std::size_t> hand_out_;
  std::optional<Start> load_;
  Fifo<Start> start_;
  Fifo<Beat> ready_;
  std::optional<Beat> next_;
  bool started_ = false;
  std::vector<PairHeader> side_;
  Delay<std::optional<ReturnedBeat>> programme_;  // cchip_axis_programme without its last register
  std::optional<Beat> beat_;
  std::optional<PairResult> result_;
  std::size_t leaving_ = 0;  // context of result_
  Exhaustive found_;
};

/// cchip_primtest in any of its shapes.
class Primtest {
 public:
  struct Parameters {
    int coord_w = defs::coord_w_default;
    int substages = defs::substages_default;
    int contexts = defs::contexts_default(defs::substages_default);
    Options options = {};
  };

  explicit Primtest(const Parameters& parameters);

  const Parameters& parameters() const { return parameters_; }
  bool s_pair_ready() const { return ready_; }
  bool m_result_valid() const { return results_.m_valid(); }
  /// Defined while m_result_valid().
  const PairResult& m_result() const { return results_.m_data(); }
  bool idle() const { return idle_; }
  /// For statistics: a beat leaves the controller / a pair waits for an axis slot.
  bool beat_valid() const { return controller_.beat().has_value(); }
  bool pair_waits() const { return controller_.pair_waits(); }

  /// Rising edge. `pair` is s_pair with its valid.
  void clock(const std::optional<PairRequest>& pair, bool m_result_ready);
  /// Rising edge with rst = 1.
  void reset();

 private:
  struct Operands {
    GridPrimitive a;
    GridPrimitive b;
    int err = 0;
  };
  Parameters parameters_;
  std::size_t pairs_ = 0;
  bool ready_ = false;
  bool awake_ = false;  // a context is ready
  bool idle_ = true;
  std::vector<Operands> operands_;
  AxisController controller_;
  Delay<std::optional<ReturnedBeat>> pipeline_;  // the four macro stages
  Fifo<PairResult> results_;
};

}  // namespace cchip::model

#endif
