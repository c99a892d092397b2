// SPDX-License-Identifier: Apache-2.0
#include <cchip/defs.hpp>
#include <cchip/wave_layout.hpp>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <stdexcept>

namespace cchip {
namespace {

/// Flags of a trace in a GTKWave save file (right-justified).
enum class Radix : unsigned { hexadecimal = 0x22, decimal = 0x24, binary = 0x28, octal = 0x30, signed_decimal = 0x420 };

/// A vector in the waveform: full name below the module, width in bits.
struct Vector {
  std::string name;
  int width;
};

class SaveFile {
 public:
  explicit SaveFile(std::ostream& out) : out_(out) { out_ << std::hex; }

  void line(const std::string& text) { out_ << text << '\n'; }
  void open_group(const std::string& title) { line("@800200\n-" + title); }
  void close_group(const std::string& title) { line("@1000200\n-" + title); }
  /// The same for a group that is shown folded.
  void open_folded(const std::string& title) { line("@c00200\n-" + title); }
  void close_folded(const std::string& title) { line("@1401200\n-" + title); }

  void bit(const std::string& label, const std::string& name) { signal(label, name, Radix::binary); }
  void vector(const std::string& label, const Vector& vector, Radix radix) {
    signal(label, vector.name + range(vector), radix);
  }
  /// Bits [lsb +: width] of a vector as a signal of their own; GTKWave counts bits from the left.
  void field(const std::string& label, const Vector& vector, int lsb, int width, Radix radix) {
    flags(radix);
    out_ << "#{" << label << '}';
    for (int bit = lsb + width - 1; bit >= lsb; --bit) {
      out_ << " (" << std::dec << vector.width - 1 - bit << std::hex << ')' << module << vector.name << range(vector);
    }
    out_ << '\n';
  }
  /// x, y, z of a point of a vector of points, x lowest.
  void point(const std::string& label, const Vector& vector, int index, int width) {
    for (int d = 0; d < 3; ++d) {
      field(label + ' ' + "xyz"[d], vector, (3 * index + d) * width, width, Radix::signed_decimal);
    }
  }
  /// {class, k, l} of an axis code: its three octal digits.
  void axis_code(const Vector& vector) { this->vector("axis (class k l)", vector, Radix::octal); }

 private:
  static constexpr const char* module = "TOP.cchip_primtest_tri_tri.u_primtest.";
  static std::string range(const Vector& vector) { return "[" + std::to_string(vector.width - 1) + ":0]"; }
  void flags(Radix radix) { out_ << '@' << static_cast<unsigned>(radix) << '\n'; }
  void signal(const std::string& label, const std::string& name, Radix radix) {
    flags(radix);
    out_ << "+{" << label << "} " << module << name << '\n';
  }

  std::ostream& out_;
};

constexpr int w = defs::coord_w_default;
constexpr int substages = defs::substages_default;
constexpr int context_w = 6;
/// State of a pair's programme that travels with a beat: context above 37 bits of cchip_axis_programme, of
/// which the lowest are {code, programme}.
constexpr int user_w = context_w + 37;
static_assert(defs::contexts_default(substages) > 1 << (context_w - 1) &&
              defs::contexts_default(substages) <= 1 << context_w);

/// valid of the pipeline after `clocks` of its registers.
void pipeline_valid(SaveFile& file, int clocks) {
  const Vector chain{"u_pipeline.u_valid.gen_stages.chain", defs::pipe_latency(substages) + 1};
  file.field("valid", chain, clocks, 1, Radix::binary);
}

void stream_s_pair(SaveFile& file) {
  const std::string title = "stream s_pair";
  file.open_group(title);
  file.bit("valid", "s_pair_valid");
  file.bit("ready", "s_pair_ready");
  file.vector("tag", {"s_pair_tag", defs::tag_w}, Radix::hexadecimal);
  file.vector("mode", {"s_pair_mode", defs::mode_w}, Radix::decimal);
  file.vector("err", {"s_pair_err", defs::err_w}, Radix::decimal);
  file.open_folded("coordinates");
  for (int i = 0; i < 3; ++i) file.point("V" + std::to_string(i), {"s_pair_a", 3 * defs::vertices * w}, i, w);
  for (int i = 0; i < 3; ++i) file.point("W" + std::to_string(i), {"s_pair_b", 3 * defs::vertices * w}, i, w);
  file.close_folded("coordinates");
  file.vector("pairs inside", {"pairs_q", context_w}, Radix::decimal);
  file.close_group(title);
}

void axis_controller(SaveFile& file) {
  const std::string title = "axis controller";
  file.open_group(title);
  file.bit("pair waits", "u_controller.pair_waits");
  file.bit("beat valid", "u_controller.m_beat_valid");
  file.vector("context", {"u_controller.m_beat_context", context_w}, Radix::decimal);
  file.field("programme", {"u_controller.m_beat_user", user_w}, 0, defs::prog_w, Radix::decimal);
  file.axis_code({"u_controller.m_beat_code", defs::axis_code_w});
  file.close_group(title);
}

void macro_stages(SaveFile& file) {
  file.open_group("macro stage 1 select");
  pipeline_valid(file, defs::select_latency());
  file.open_folded("edges and points");
  file.point("e from", {"u_pipeline.select_e_from", 3 * w}, 0, w);
  file.point("e to", {"u_pipeline.select_e_to", 3 * w}, 0, w);
  file.point("f from", {"u_pipeline.select_f_from", 3 * w}, 0, w);
  file.point("f to", {"u_pipeline.select_f_to", 3 * w}, 0, w);
  for (int i = 0; i < 3; ++i) file.point("point " + std::to_string(i), {"u_pipeline.select_points", 9 * w}, i, w);
  file.close_folded("edges and points");
  file.close_group("macro stage 1 select");

  file.open_group("macro stage 2 axis");
  pipeline_valid(file, defs::select_latency() + substages);
  file.point("axis", {"u_pipeline.axis", 3 * defs::axis_w(w)}, 0, defs::axis_w(w));
  file.close_group("macro stage 2 axis");

  file.open_group("macro stage 3 project");
  pipeline_valid(file, defs::select_latency() + 2 * substages);
  for (int point = 0; point < 3; ++point) {
    file.field("p" + std::to_string(point), {"u_pipeline.projection", 3 * defs::proj_w(w)}, point * defs::proj_w(w),
               defs::proj_w(w), Radix::signed_decimal);
  }
  file.vector("axis components = 0", {"u_pipeline.project_axis_zero", 3}, Radix::binary);
  file.close_group("macro stage 3 project");

  file.open_group("macro stage 4 compare");
  file.bit("valid", "verdict_valid");
  file.field("context", {"verdict_user", user_w}, user_w - context_w, context_w, Radix::decimal);
  file.field("axis (class k l)", {"verdict_user", user_w}, defs::prog_w, defs::axis_code_w, Radix::octal);
  file.bit("separated", "verdict_separated");
  file.close_group("macro stage 4 compare");
}

void stream_m_result(SaveFile& file) {
  const std::string title = "stream m_result";
  file.open_group(title);
  file.bit("valid", "m_result_valid");
  file.bit("ready", "m_result_ready");
  file.vector("tag", {"m_result_tag", defs::tag_w}, Radix::hexadecimal);
  file.bit("hit", "m_result_hit");
  file.bit("grid", "m_result_grid");
  file.bit("definite", "m_result_definite");
  file.axis_code({"m_result_axis", defs::axis_code_w});
  file.vector("beats", {"m_result_beats", defs::beats_w}, Radix::decimal);
  file.bit("idle", "idle");
  file.close_group(title);
}

}  // namespace

void write_gtkw(const std::string& fst_path) {
  const std::filesystem::path fst(fst_path);
  const std::filesystem::path path = std::filesystem::path(fst).replace_extension(".gtkw");
  std::ofstream out(path);
  SaveFile file(out);
  file.line("[*] Signals of cchip_primtest_tri_tri along the way of a pair");
  file.line("[dumpfile] \"" + std::filesystem::absolute(fst).lexically_normal().string() + "\"");
  file.line("[timestart] 0");
  file.line("[size] 1920 1080");
  file.line("[pos] -1 -1");
  file.line("*-5.9 0 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1");
  file.line("[sst_expanded] 0");
  file.line("[signals_width] 230");
  file.bit("clk", "clk");
  file.bit("rst", "rst");
  stream_s_pair(file);
  axis_controller(file);
  macro_stages(file);
  stream_m_result(file);
  out.close();
  if (!out) throw std::runtime_error(path.string() + ": cannot be written; check folder and permissions");
}

}  // namespace cchip
