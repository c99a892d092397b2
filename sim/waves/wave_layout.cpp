// SPDX-License-Identifier: Apache-2.0
#include <cchip/waves/wave_layout.hpp>
#include <cchip/wire/definitions.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <stdexcept>

namespace cchip {
namespace {

constexpr int w = defs::coord_w_default;
constexpr int substages = defs::substages_default;
constexpr int context_w = 6;
static_assert(defs::contexts_default(substages) > 1 << (context_w - 1) &&
              defs::contexts_default(substages) <= 1 << context_w);
constexpr int user_w = context_w + defs::state_w;
constexpr int queue_count_w = 9;  ///< of QUEUE_DEPTH = 256

/// Flags of a trace in a GTKWave save file (right-justified).
enum class Radix : unsigned { hexadecimal = 0x22, decimal = 0x24, binary = 0x28, octal = 0x30, signed_decimal = 0x420 };

/// A vector in the waveform: full name below the module, width in bits.
struct Vector {
  std::string name;
  int width;
};

/// Full name of the module whose signals a file shows, and the vertices of its primitives.
struct Module {
  explicit Module(ModuleId id)
      : name(std::string("cchip_primtest_") + to_name(id)),
        verts_a(id == ModuleId::quad_quad ? 4 : 3),
        verts_b(id == ModuleId::tri_tri ? 3 : 4) {}
  int points() const { return defs::points(verts_a, verts_b); }
  std::string name;
  int verts_a;
  int verts_b;
};

class SaveFile {
 public:
  SaveFile(std::ostream& out, const std::string& module) : out_(out), prefix_("TOP." + module + ".") {
    out_ << std::hex;
  }

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
      out_ << " (" << std::dec << vector.width - 1 - bit << std::hex << ')' << prefix_ << vector.name << range(vector);
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
  /// The programme state that travels with a beat (header of cchip_axis_programme), the context above it.
  void state(const Vector& vector) {
    field("context", vector, defs::state_w, context_w, Radix::decimal);
    field("programme", vector, 0, defs::prog_w, Radix::decimal);
    field("axis (class k l)", vector, 3, defs::axis_code_w, Radix::octal);
    field("info", vector, 12, defs::state_w - 20, Radix::binary);
    field("beats before", vector, defs::state_w - 8, defs::beats_w, Radix::decimal);
    field("open", vector, defs::state_w - 2, 1, Radix::binary);
    field("certain so far", vector, defs::state_w - 1, 1, Radix::binary);
  }

 private:
  static std::string range(const Vector& vector) { return "[" + std::to_string(vector.width - 1) + ":0]"; }
  void flags(Radix radix) { out_ << '@' << static_cast<unsigned>(radix) << '\n'; }
  void signal(const std::string& label, const std::string& name, Radix radix) {
    flags(radix);
    out_ << "+{" << label << "} " << prefix_ << name << '\n';
  }

  std::ostream& out_;
  std::string prefix_;
};

/// valid of the pipeline after `clocks` of its registers.
void pipeline_valid(SaveFile& file, int clocks) {
  const Vector chain{"u_primtest.u_pipeline.u_valid.gen_stages.chain", defs::pipe_latency(substages) + 1};
  file.field("valid", chain, clocks, 1, Radix::binary);
}

void points(SaveFile& file, const std::string& label, int count, const Vector& vector) {
  for (int i = 0; i < count; ++i) file.point(label + std::to_string(i), vector, i, w);
}

void stream_s_pair(SaveFile& file, const Module& module) {
  const std::string title = "stream s_pair";
  file.open_group(title);
  file.bit("valid", "s_pair_valid");
  file.bit("ready", "s_pair_ready");
  file.vector("tag", {"s_pair_tag", defs::tag_w}, Radix::hexadecimal);
  file.vector("mode", {"s_pair_mode", defs::mode_w}, Radix::decimal);
  file.vector("err", {"s_pair_err", defs::err_w}, Radix::decimal);
  file.open_folded("coordinates");
  points(file, "V", module.verts_a, {"s_pair_a", 3 * defs::vertices * w});
  points(file, "W", module.verts_b, {"s_pair_b", 3 * defs::vertices * w});
  file.close_folded("coordinates");
  file.vector("pairs inside", {"u_primtest.pairs_q", context_w}, Radix::decimal);
  file.close_group(title);
}

void axis_controller(SaveFile& file) {
  const std::string title = "axis controller";
  file.open_group(title);
  file.bit("pair waits", "u_primtest.u_controller.pair_waits");
  file.bit("pair starts", "u_primtest.u_controller.start_valid");
  file.bit("pair goes on", "u_primtest.u_controller.ready_valid");
  file.bit("beat valid", "u_primtest.beat_valid");
  file.open_folded("programme state of the beat");
  file.state({"u_primtest.beat_user", user_w});
  file.close_folded("programme state of the beat");
  file.axis_code({"u_primtest.beat_code", defs::axis_code_w});
  file.bit("allow above, a clock later", "u_primtest.beat_allow_above");
  file.bit("allow below, a clock later", "u_primtest.beat_allow_below");
  file.close_group(title);
}

void stage_select(SaveFile& file, const Module& module) {
  const std::string title = "macro stage 1 select";
  file.open_group(title);
  pipeline_valid(file, defs::select_latency());
  file.open_folded("edges and points");
  file.point("e from", {"u_primtest.u_pipeline.select_e_from", 3 * w}, 0, w);
  file.point("e to", {"u_primtest.u_pipeline.select_e_to", 3 * w}, 0, w);
  file.point("f from", {"u_primtest.u_pipeline.select_f_from", 3 * w}, 0, w);
  file.point("f to", {"u_primtest.u_pipeline.select_f_to", 3 * w}, 0, w);
  points(file, "point ", module.points(), {"u_primtest.u_pipeline.select_points", 3 * w * module.points()});
  file.close_folded("edges and points");
  file.vector("own points", {"u_primtest.u_pipeline.select_own", 2}, Radix::binary);
  file.close_group(title);
}

void stage_axis(SaveFile& file) {
  const std::string title = "macro stage 2 axis";
  file.open_group(title);
  pipeline_valid(file, defs::select_latency() + substages);
  file.point("axis", {"u_primtest.u_pipeline.axis", 3 * defs::axis_w(w)}, 0, defs::axis_w(w));
  file.vector("|e| + |f|", {"u_primtest.u_pipeline.axis_edge_norm", defs::norm_w(w)}, Radix::decimal);
  file.close_group(title);
}

void stage_project(SaveFile& file, const Module& module) {
  const std::string title = "macro stage 3 project";
  const std::string pipeline = "u_primtest.u_pipeline.";
  const auto slices = [&](const std::string& label, const std::string& name, int width, Radix radix) {
    for (int i = 0; i < module.points(); ++i) {
      file.field(label + std::to_string(i), {pipeline + name, width * module.points()}, i * width, width, radix);
    }
  };
  file.open_group(title);
  pipeline_valid(file, defs::select_latency() + 2 * substages);
  slices("p", "projection", defs::proj_w(w), Radix::signed_decimal);
  file.open_folded("error bounds, two clocks later");
  file.vector("sign bound", {pipeline + "sign_bound", defs::bound_w(w)}, Radix::decimal);
  file.vector("gap bound", {pipeline + "gap_bound", defs::bound_w(w)}, Radix::decimal);
  file.close_folded("error bounds, two clocks later");
  file.vector("axis < 0 (zyx)", {pipeline + "project_axis_negative", 3}, Radix::binary);
  file.vector("axis = 0 (zyx)", {pipeline + "project_axis_zero", 3}, Radix::binary);
  file.vector("largest component", {pipeline + "project_axis_largest", 2}, Radix::decimal);
  file.close_group(title);
}

void stage_compare(SaveFile& file, const Module& module) {
  const std::string title = "macro stage 4 compare";
  const Vector user{"u_primtest.verdict_user", user_w};
  file.open_group(title);
  file.bit("valid", "u_primtest.verdict_valid");
  file.open_folded("programme state of the verdict");
  file.state(user);
  file.close_folded("programme state of the verdict");
  file.field("axis (class k l)", user, 3, defs::axis_code_w, Radix::octal);
  file.bit("separated", "u_primtest.verdict_separated");
  file.bit("certain gap", "u_primtest.verdict_certain_gap");
  file.vector("points < 0", {"u_primtest.verdict_negative", module.points()}, Radix::binary);
  file.vector("points = 0", {"u_primtest.verdict_zero", module.points()}, Radix::binary);
  file.bit("sign certain", "u_primtest.verdict_certain");
  file.bit("boxes separated", "u_primtest.verdict_box_separated");
  file.bit("boxes certain", "u_primtest.verdict_box_certain");
  file.close_group(title);
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

// ---- the reconfigurable subsystem

void pair_streams(SaveFile& file) {
  const std::string title = "pairs and answers";
  file.open_group(title);
  file.bit("pair valid", "s_pair_valid");
  file.bit("pair ready", "s_pair_ready");
  file.vector("pair kind", {"s_pair_kind", 2}, Radix::decimal);
  file.vector("pair tag", {"s_pair_tag", defs::tag_w}, Radix::hexadecimal);
  for (int kind = 1; kind < 4; ++kind) {
    const Vector waiting{"waiting", 3 * queue_count_w};
    file.field("waiting, kind " + std::to_string(kind), waiting, queue_count_w * (kind - 1), queue_count_w,
               Radix::decimal);
  }
  file.bit("answer valid", "m_result_valid");
  file.bit("answer ready", "m_result_ready");
  file.vector("answer kind", {"m_result_kind", 2}, Radix::decimal);
  file.vector("answer tag", {"m_result_tag", defs::tag_w}, Radix::hexadecimal);
  file.close_group(title);
}

void scheduler(SaveFile& file) {
  const std::string title = "scheduler";
  file.open_group(title);
  file.bit("request", "swap_valid");
  file.vector("slot", {"swap_slot", 8}, Radix::decimal);
  file.vector("module", {"swap_module", 8}, Radix::decimal);
  file.bit("report", "report_valid");
  file.vector("code", {"report_code", defs::swap_w}, Radix::decimal);
  file.bit("interrupt", "irq");
  file.close_group(title);
}

void config_controller(SaveFile& file) {
  const std::string title = "configuration controller";
  file.open_group(title);
  file.vector("phase", {"phase", defs::phase_w}, Radix::decimal);
  file.bit("memory: address", "m_axi_arvalid");
  file.bit("memory: data", "m_axi_rvalid");
  file.bit("memory: ready", "m_axi_rready");
  file.bit("port: write", "cfg_valid");
  file.vector("port: byte", {"cfg_data", 8}, Radix::hexadecimal);
  file.close_group(title);
}

void slot(SaveFile& file, int number) {
  const std::string title = "slot " + std::to_string(number);
  const std::string scope = "gen_slots[" + std::to_string(number) + "].u_slot.";
  file.open_group(title);
  file.vector("module", {scope + "rm_id", 8}, Radix::decimal);
  file.vector("pairs inside", {scope + "outstanding", 16}, Radix::decimal);
  for (const char* name : {"stop", "quiet", "decouple", "decoupled", "hold_reset", "roc_start", "roc_busy"}) {
    file.bit(name, scope + name);
  }
  file.vector("region: module", {scope + "r_rm_id", 8}, Radix::hexadecimal);
  file.bit("region: ready", scope + "r_pair_ready");
  file.bit("region: answer", scope + "r_result_valid");
  file.bit("pair accepted", scope + "accept");
  file.bit("answer given", scope + "answer");
  file.close_group(title);
}

// ---- files

constexpr double wave_frames = 7.5;  ///< GTKWave's frames of 200 pixels in a window of 1920, less the names

/// What the window shows first: start, time units, and GTKWave's zoom: -log2 of the time units per frame.
struct View {
  std::uint64_t start;
  double zoom;
};

std::filesystem::path layout_path(const std::string& fst_path) {
  return std::filesystem::path(fst_path).replace_extension(".gtkw");
}

void begin(SaveFile& file, const std::string& title, const std::string& fst_path, const View& view) {
  file.line("[*] " + title);
  file.line("[dumpfile] \"" + std::filesystem::absolute(fst_path).lexically_normal().string() + "\"");
  file.line("[timestart] " + std::to_string(view.start));
  file.line("[size] 1920 1080");
  file.line("[pos] -1 -1");
  std::string zoom = "*" + std::to_string(view.zoom) + " " + std::to_string(view.start);
  for (int i = 0; i < 26; ++i) zoom += " -1";
  file.line(zoom);
  file.line("[sst_expanded] 0");
  file.line("[signals_width] 230");
  file.bit("clk", "clk");
  file.bit("rst", "rst");
}

void end(std::ofstream& out, const std::filesystem::path& path) {
  out.close();
  if (!out) throw std::runtime_error(path.string() + ": cannot be written; check folder and permissions");
}

}  // namespace

void write_gtkw(const std::string& fst_path, ModuleId id) {
  const Module module(id);
  const std::filesystem::path path = layout_path(fst_path);
  std::ofstream out(path);
  SaveFile file(out, module.name);
  begin(file, "Signals of " + module.name + " along the way of a pair", fst_path, {0, -5.9});
  stream_s_pair(file, module);
  axis_controller(file);
  stage_select(file, module);
  stage_axis(file);
  stage_project(file, module);
  stage_compare(file, module);
  stream_m_result(file);
  end(out, path);
}

void write_swap_gtkw(const std::string& fst_path, std::uint64_t from, std::uint64_t to) {
  const std::filesystem::path path = layout_path(fst_path);
  std::ofstream out(path);
  SaveFile file(out, "cchip_primtest_subsystem");
  const std::uint64_t margin = (to - from) / 20;
  const std::uint64_t first = from > margin ? from - margin : 0;
  const double per_frame = static_cast<double>(to + margin - first) / wave_frames;
  begin(file, "A swap of the reconfigurable subsystem", fst_path, {first, -std::log2(per_frame)});
  pair_streams(file);
  scheduler(file);
  config_controller(file);
  slot(file, 0);
  slot(file, 1);
  end(out, path);
}

}  // namespace cchip
