// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/internal/wire/axis.hpp>
#include <cchip/internal/wire/code_names.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace cchip {
namespace {

constexpr int w = defs::coord_w_default;
constexpr int substages = defs::substages_default;
constexpr int context_w = 6;
static_assert(defs::contexts_default(substages) > 1 << (context_w - 1) &&
              defs::contexts_default(substages) <= 1 << context_w);
constexpr int user_w = context_w + defs::state_w;
constexpr int queue_count_w = 8;  ///< of QUEUE_DEPTH = 128

/// Flags of a trace in a GTKWave save file (right-justified).
enum class Radix : unsigned { hexadecimal = 0x22, decimal = 0x24, binary = 0x28, octal = 0x30, signed_decimal = 0x420 };

constexpr unsigned translated = 0x2000;  ///< flag of a trace: texts of a file in place of its values

/// The texts of a code's values, which GTKWave shows in place of the numbers.
struct Names {
  const char* ending;                   ///< of the file that holds them
  int width;                            ///< of the code, bit
  Radix radix;                          ///< octal: with leading zeros
  std::string (*text)(unsigned value);  ///< empty: this value has none
};

template <class Code>
std::string text_of(unsigned value) {
  const char* name = name_of(static_cast<Code>(value));
  return name == nullptr ? "" : name;
}

const Names axis_names = {"axis", defs::axis_code_w, Radix::octal, [](unsigned value) {
                            return to_symbol(axis_code_from_bits(static_cast<std::uint16_t>(value)));
                          }};
const Names mode_names = {"mode", defs::mode_w, Radix::decimal, text_of<PairMode>};
const Names programme_names = {"programme", defs::prog_w, Radix::decimal, text_of<Programme>};
const Names kind_names = {"kind", defs::kind_w, Radix::decimal, text_of<ModuleId>};
const Names module_names = {"module", defs::rm_id_w, Radix::decimal, text_of<ModuleId>};
const Names phase_names = {"phase", defs::phase_w, Radix::decimal, text_of<SwapPhase>};
const Names swap_names = {"swap", defs::swap_w, Radix::decimal, text_of<SwapCode>};
const Names end_names = {"end", defs::end_w, Radix::decimal, text_of<QueryCode>};
const Names answer_names = {"answer", defs::query_answer_w, Radix::decimal, text_of<QueryAnswer>};

/// One row of a layout: what GTKWave shows, in the order of the window.
struct Row {
  enum class What { open, open_folded, close, close_folded, signal, field } what;
  std::string label;      ///< of a signal or field; title of a group
  std::string name = {};  ///< full name below the module
  int width = 1;          ///< of the whole signal, bit
  Radix radix = Radix::binary;
  int lsb = 0;  ///< of a field
  int field_width = 0;
  const Names* names = nullptr;  ///< of its values
};
using Rows = std::vector<Row>;

Row bit(std::string label, std::string name) { return {Row::What::signal, std::move(label), std::move(name)}; }
Row vector(std::string label, std::string name, int width, Radix radix) {
  return {Row::What::signal, std::move(label), std::move(name), width, radix};
}
/// A bit for each slot; simulators name a vector of one bit with its range.
Row of_slots(std::string label, const std::string& name, int slots) {
  return slots == 1 ? Row{Row::What::signal, std::move(label), name + "[0:0]", 1, Radix::binary}
                    : vector(std::move(label), name, slots, Radix::binary);
}
/// A code that is shown by name.
Row vector(std::string label, std::string name, const Names& names) {
  Row row = vector(std::move(label), std::move(name), names.width, names.radix);
  row.names = &names;
  return row;
}
/// Bits [lsb +: field_width] of a vector as a separate signal.
Row field(std::string label, const std::string& name, int width, int lsb, int field_width, Radix radix) {
  return {Row::What::field, std::move(label), name, width, radix, lsb, field_width};
}
/// A field of a record.
Row field(std::string label, const std::string& name, int width, defs::Field f, Radix radix) {
  return field(std::move(label), name, width, f.lsb, f.width, radix);
}

/// A field that is a code, shown by name.
Row field(std::string label, const std::string& name, int width, defs::Field f, const Names& names) {
  Row row = field(std::move(label), name, width, f, names.radix);
  row.names = &names;
  return row;
}

Rows operator+(Rows rows, const Rows& more) {
  rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}
Rows group(const std::string& title, const Rows& rows) {
  return Rows{{Row::What::open, title}} + rows + Rows{{Row::What::close, title}};
}
/// The same, shown folded.
Rows folded(const std::string& title, const Rows& rows) {
  return Rows{{Row::What::open_folded, title}} + rows + Rows{{Row::What::close_folded, title}};
}

/// Elements of `element_width` bits of a vector, element 0 lowest.
Rows elements(const std::string& label, const std::string& name, int count, int element_width, Radix radix) {
  Rows rows;
  for (int i = 0; i < count; ++i) {
    rows.push_back(
        field(label + std::to_string(i), name, count * element_width, i * element_width, element_width, radix));
  }
  return rows;
}
/// x, y, z of a point, x lowest; of `points` points the one with this index.
Rows point(const std::string& label, const std::string& name, int component_w, int index = 0, int points = 1) {
  Rows rows;
  for (int d = 0; d < 3; ++d) {
    rows.push_back(field(label + ' ' + "xyz"[d], name, 3 * component_w * points, (3 * index + d) * component_w,
                         component_w, Radix::signed_decimal));
  }
  return rows;
}
Rows points(const std::string& label, const std::string& name, int shown, int points) {
  Rows rows;
  for (int i = 0; i < shown; ++i) rows = rows + point(label + std::to_string(i), name, w, i, points);
  return rows;
}

/// The programme state that travels with a beat (header of cchip_axis_programme), the context above it.
Rows programme_state(const std::string& name) {
  const auto part = [&](const char* label, defs::Field of, Radix radix) {
    return field(label, name, user_w, of.lsb, of.width, radix);
  };
  return {part("context", {defs::state_w, context_w}, Radix::decimal),
          field("programme", name, user_w, defs::state_programme, programme_names),
          field("axis", name, user_w, defs::state_code, axis_names),
          part("info", defs::state_info, Radix::binary),
          part("beats before", defs::state_beats, Radix::decimal),
          part("open", defs::state_open, Radix::binary),
          part("certain so far", defs::state_certain, Radix::binary),
          part("deep so far", defs::state_deep, Radix::binary)};
}

/// valid of the pipeline after `clocks` of its registers.
Row pipeline_valid(int clocks) {
  return field("valid", "u_primtest.u_pipeline.u_valid.gen_stages.chain", defs::pipe_latency(substages) + 1, clocks, 1,
               Radix::binary);
}

/// A primitive test, in the order in which a pair passes through it.
Rows primtest_layout(ModuleId id) {
  const auto verts_a = static_cast<int>(vertices_of(id)[0]);
  const auto verts_b = static_cast<int>(vertices_of(id)[1]);
  const int projected = defs::points(verts_a, verts_b);
  const std::string top = "u_primtest.";
  const std::string controller = top + "u_controller.";
  const std::string pipeline = top + "u_pipeline.";
  const int after_select = defs::select_latency();
  return group("stream s_pair", Rows{bit("valid", "s_pair_valid"), bit("ready", "s_pair_ready"),
                                     vector("tag", "s_pair_tag", defs::tag_w, Radix::hexadecimal),
                                     vector("mode", "s_pair_mode", mode_names),
                                     vector("err", "s_pair_err", defs::err_w, Radix::decimal)} +
                                    folded("coordinates", points("V", "s_pair_a", verts_a, defs::vertices) +
                                                              points("W", "s_pair_b", verts_b, defs::vertices)) +
                                    Rows{vector("pairs inside", top + "pairs_q", context_w, Radix::decimal)}) +
         group("axis controller",
               Rows{bit("pair waits", controller + "pair_waits"), bit("pair starts", controller + "start_valid"),
                    bit("pair continues", controller + "ready_valid"), bit("beat valid", top + "beat_valid")} +
                   folded("programme state of the beat", programme_state(top + "beat_user")) +
                   Rows{vector("axis", top + "beat_code", axis_names),
                        bit("allow above, a clock later", top + "beat_allow_above"),
                        bit("allow below, a clock later", top + "beat_allow_below")}) +
         group("macro stage 1 select",
               Rows{pipeline_valid(after_select)} +
                   folded("edges and points", point("e from", pipeline + "select_e_from", w) +
                                                  point("e to", pipeline + "select_e_to", w) +
                                                  point("f from", pipeline + "select_f_from", w) +
                                                  point("f to", pipeline + "select_f_to", w) +
                                                  points("point ", pipeline + "select_points", projected, projected)) +
                   Rows{vector("own points", pipeline + "select_own", 2, Radix::binary)}) +
         group("macro stage 2 axis",
               Rows{pipeline_valid(after_select + substages)} + point("axis", pipeline + "axis", defs::axis_w(w)) +
                   Rows{vector("|e| + |f|", pipeline + "axis_edge_norm", defs::norm_w(w), Radix::decimal)}) +
         group("macro stage 3 project",
               Rows{pipeline_valid(after_select + 2 * substages)} +
                   elements("p", pipeline + "projection", projected, defs::proj_w(w), Radix::signed_decimal) +
                   folded("error bounds, two clocks later",
                          {vector("sign bound", pipeline + "sign_bound", defs::bound_w(w), Radix::decimal),
                           vector("gap bound", pipeline + "gap_bound", defs::bound_w(w), Radix::decimal)}) +
                   Rows{vector("axis < 0 (zyx)", pipeline + "project_axis_negative", 3, Radix::binary),
                        vector("axis = 0 (zyx)", pipeline + "project_axis_zero", 3, Radix::binary),
                        vector("largest component", pipeline + "project_axis_largest", 2, Radix::decimal)}) +
         group("macro stage 4 compare",
               Rows{bit("valid", top + "verdict_valid")} +
                   folded("programme state of the verdict", programme_state(top + "verdict_user")) +
                   Rows{field("axis", top + "verdict_user", user_w, defs::state_code, axis_names),
                        bit("separated", top + "verdict_separated"), bit("certain gap", top + "verdict_certain_gap"),
                        vector("points < 0", top + "verdict_negative", projected, Radix::binary),
                        vector("points = 0", top + "verdict_zero", projected, Radix::binary),
                        bit("sign certain", top + "verdict_certain"),
                        bit("boxes separated", top + "verdict_box_separated"),
                        bit("boxes certain", top + "verdict_box_certain")}) +
         group("stream m_result",
               {bit("valid", "m_result_valid"), bit("ready", "m_result_ready"),
                vector("tag", "m_result_tag", defs::tag_w, Radix::hexadecimal), bit("hit", "m_result_hit"),
                bit("grid", "m_result_grid"), bit("definite", "m_result_definite"),
                vector("axis", "m_result_axis", axis_names),
                vector("beats", "m_result_beats", defs::beats_w, Radix::decimal), bit("idle", "idle")});
}

Rows slot_layout(int number) {
  const std::string slot = std::to_string(number);
  const std::string scope = "u_slots.gen_slots[" + slot + "].u_slot.";
  const std::string ledger = "u_slots.u_dispatcher.gen_ledgers[" + slot + "].u_ledger.";
  Rows rows = {vector("module", scope + "rm_id", module_names),
               vector("pairs inside", ledger + "outstanding", 16, Radix::decimal), bit("room", ledger + "room"),
               bit("stop", ledger + "stop"), bit("quiet", ledger + "quiet")};
  for (const char* name : {"decouple", "decoupled", "hold_reset", "roc_start", "roc_busy"}) {
    rows.push_back(bit(name, scope + name));
  }
  return group("slot " + slot,
               rows + Rows{bit("pairs answered", ledger + "decoupled"),
                           vector("region: module", scope + "r_rm_id", module_names),
                           bit("region: vertex", scope + "r_vertex_valid"),
                           bit("region: result", scope + "r_result_valid"), bit("answer", ledger + "m_valid")});
}

/// The reconfigurable subsystem with two slots.
Rows subsystem_layout() {
  const std::string swaps = "u_swaps.gen_swaps.";
  Rows waiting;
  for (int kind = 1; kind < 4; ++kind) {
    waiting.push_back(field("waiting, kind " + std::to_string(kind), "waiting", 4 * queue_count_w, queue_count_w * kind,
                            queue_count_w, Radix::decimal));
  }
  return group("pairs and answers",
               Rows{bit("pair valid", "s_pair_valid"), bit("pair ready", "s_pair_ready"),
                    vector("pair kind", "s_pair_kind", kind_names),
                    vector("pair tag", "s_pair_tag", defs::tag_w, Radix::hexadecimal)} +
                   waiting +
                   Rows{bit("answer valid", "m_result_valid"), bit("answer ready", "m_result_ready"),
                        vector("answer kind", "m_result_kind", kind_names),
                        vector("answer tag", "m_result_tag", defs::tag_w, Radix::hexadecimal)}) +
         group("scheduler",
               {bit("request", swaps + "swap_valid"),
                field("slot", swaps + "swap_data", defs::swap_request_w, defs::swap_request_slot, Radix::decimal),
                field("module", swaps + "swap_data", defs::swap_request_w, defs::swap_request_module, module_names),
                bit("report", swaps + "report_valid"),
                field("code", swaps + "report_data", defs::swap_report_w, defs::swap_report_code, swap_names),
                bit("interrupt", "irq")}) +
         group("configuration controller",
               {vector("phase", swaps + "phase_now", phase_names), bit("memory: address", "m_axi_arvalid"),
                bit("memory: data", "m_axi_rvalid"), bit("memory: ready", "m_axi_rready"),
                bit("port: write", "cfg_valid"), vector("port: byte", "cfg_data", 8, Radix::hexadecimal)}) +
         slot_layout(0) + slot_layout(1);
}

std::string layout_path(const std::string& fst_path) {
  return std::filesystem::path(fst_path).replace_extension(".gtkw");
}
std::string names_path(const std::string& fst_path, const Names& names) {
  return layout_path(fst_path) + '.' + names.ending;
}
std::string absolute(const std::string& path) { return std::filesystem::absolute(path).lexically_normal().string(); }

/// The codes that these rows show by name.
std::set<const Names*> names_in(const Rows& rows) {
  std::set<const Names*> found;
  for (const Row& row : rows) {
    if (row.names != nullptr) found.insert(row.names);
  }
  return found;
}

/// Writes the file of a code's names: a line for each value that has one, as GTKWave prints the value.
void write_names(const std::string& fst_path, const Names& names) {
  sim::OutputFile out(names_path(fst_path, names));
  for (unsigned value = 0; value < 1U << names.width; ++value) {
    const std::string text = names.text(value);
    if (text.empty()) continue;
    if (names.radix == Radix::octal) {
      out.stream() << std::oct << std::setfill('0') << std::setw((names.width + 2) / 3);
    }
    out.stream() << value << ' ' << text << '\n';
  }
  out.commit();
}

/// Writes rows in GTKWave's format.
class SaveFile {
 public:
  SaveFile(std::ostream& out, const std::string& module, std::string fst_path)
      : out_(out), prefix_("TOP." + module + "."), fst_path_(std::move(fst_path)) {
    out_ << std::hex;
  }
  void line(const std::string& text) { out_ << text << '\n'; }
  void write(const Rows& rows) {
    for (const Row& row : rows) write(row);
  }

 private:
  void write(const Row& row) {
    switch (row.what) {
      case Row::What::open:
        return line("@800200\n-" + row.label);
      case Row::What::close:
        return line("@1000200\n-" + row.label);
      case Row::What::open_folded:
        return line("@c00200\n-" + row.label);
      case Row::What::close_folded:
        return line("@1401200\n-" + row.label);
      case Row::What::signal:
        flags(row);
        out_ << "+{" << row.label << "} " << full_name(row) << '\n';
        return;
      case Row::What::field:
        flags(row);
        out_ << "#{" << row.label << '}';
        for (int i = row.lsb + row.field_width - 1; i >= row.lsb; --i) {  // GTKWave counts bits from the left
          out_ << " (" << std::dec << row.width - 1 - i << std::hex << ')' << full_name(row);
        }
        out_ << '\n';
    }
  }
  void flags(const Row& row) {
    const unsigned names = row.names == nullptr ? 0 : translated;
    out_ << '@' << (static_cast<unsigned>(row.radix) | names) << '\n';
    if (row.names != nullptr) out_ << "^1 " << absolute(names_path(fst_path_, *row.names)) << '\n';
  }
  std::string full_name(const Row& row) const {
    return prefix_ + row.name + (row.width == 1 ? "" : "[" + std::to_string(row.width - 1) + ":0]");
  }

  std::ostream& out_;
  std::string prefix_;
  std::string fst_path_;
};

// ---- files

constexpr double wave_frames = 7.5;  ///< GTKWave's frames of 200 pixels in a window of 1920, less the names

/// What the window shows first: start, time units, and GTKWave's zoom: -log2 of the time units per frame.
struct View {
  std::uint64_t start;
  double zoom;
};

/// With six decimals and a point, in any locale.
std::string decimal(double value) {
  std::array<char, 400> text{};
  const auto end = std::to_chars(text.begin(), text.end(), value, std::chars_format::fixed, 6).ptr;
  return {text.begin(), end};
}

void begin(SaveFile& file, const std::string& title, const std::string& fst_path, const View& view) {
  file.line("[*] " + title);
  file.line("[dumpfile] \"" + absolute(fst_path) + "\"");
  // GTKWave finds the waveform and the files of names beside the layout, too, if all were moved: it compares where it
  // reads the layout with this.
  file.line("[savefile] \"" + absolute(layout_path(fst_path)) + "\"");
  file.line("[timestart] " + std::to_string(view.start));
  file.line("[size] 1920 1080");
  file.line("[pos] -1 -1");
  std::string zoom = "*" + decimal(view.zoom) + " " + std::to_string(view.start);
  for (int i = 0; i < 26; ++i) zoom += " -1";
  file.line(zoom);
  file.line("[sst_expanded] 0");
  file.line("[signals_width] 230");
  file.line("@200\n-data are random until the first valid: flip-flops power up anyhow");
  file.write({bit("clk", "clk"), bit("rst", "rst")});
}

/// What the window shows of a module's signals.
struct Layout {
  std::string module;
  std::string title;
  View view;
  Rows rows;
};

void write(const std::string& fst_path, const Layout& layout) {
  sim::OutputFile out(layout_path(fst_path));
  SaveFile file(out.stream(), layout.module, fst_path);
  begin(file, layout.title, fst_path, layout.view);
  file.write(layout.rows);
  for (const Names* names : names_in(layout.rows)) write_names(fst_path, *names);
  out.commit();
}

/// From one time to another, which fill the window.
View view_of(std::uint64_t from, std::uint64_t to) {
  return {from, -std::log2(static_cast<double>(to - from) / wave_frames)};
}

}  // namespace

void write_gtkw(const std::string& fst_path, ModuleId id) {
  const std::string module = std::string("cchip_primtest_") + to_name(id);
  write(fst_path, {module, "Signals of " + module + " along the way of a pair", {0, -4.8}, primtest_layout(id)});
}

std::vector<std::string> gtkw_files(const std::string& fst_path, ModuleId id) {
  std::vector<std::string> files{layout_path(fst_path)};
  for (const Names* names : names_in(primtest_layout(id))) files.push_back(names_path(fst_path, *names));
  return files;
}

namespace {

/// A query from its descriptor to its answer, in the order of its way.
Rows broad_phase_layout() {
  const std::string broad = "u_broad_phase.";
  const std::string traversal = broad + "u_traversal.";
  const std::string get = broad + "u_get_data.";
  return group("1 query", {bit("valid", "s_query_valid"), bit("ready", "s_query_ready"), bit("starts", "m_start_valid"),
                           vector("context", "m_start_context", 4, Radix::decimal),
                           vector("epoch", "m_start_epoch", 2, Radix::decimal),
                           field("base of A, line", "m_start_query", 512, 0, 32, Radix::hexadecimal),
                           field("base of B, line", "m_start_query", 512, 32, 32, Radix::hexadecimal),
                           field("tag", "m_start_query", 512, 480, 32, Radix::decimal)}) +
         group("2 lines wanted",
               {bit("valid", traversal + "m_valid"), vector("place", traversal + "m_place", 6, Radix::decimal),
                vector("context", traversal + "m_context", 4, Radix::decimal),
                field("line of A", traversal + "m_lines", 64, 0, 32, Radix::hexadecimal),
                field("line of B", traversal + "m_lines", 64, 32, 32, Radix::hexadecimal)}) +
         group("3 cache", {vector("hit", "count_hit", 2, Radix::binary), vector("miss", "count_miss", 2, Radix::binary),
                           vector("waits", "count_wait", 2, Radix::binary),
                           vector("line comes", get + "s_line_valid", 2, Radix::binary),
                           field("place, A", get + "s_line_place", 12, 0, 6, Radix::decimal),
                           field("place, B", get + "s_line_place", 12, 6, 6, Radix::decimal)}) +
         group("4 memory",
               {bit("address valid", "m_axi_arvalid"), bit("address ready", "m_axi_arready"),
                vector("address", "m_axi_araddr", 64, Radix::hexadecimal), bit("beat valid", "m_axi_rvalid"),
                vector("ID", "m_axi_rid", 5, Radix::decimal), bit("last", "m_axi_rlast")}) +
         group("5 box test", {bit("valid", get + "m_pair_valid"), bit("taken next", get + "m_pair_soon"),
                              vector("place", get + "m_pair_place", 6, Radix::decimal),
                              vector("context", get + "m_pair_context", 4, Radix::decimal),
                              vector("children B, A", get + "m_pair_children", 8, Radix::binary)}) +
         group("6 verdict", {bit("valid", traversal + "s_verdict_valid"),
                             vector("place", traversal + "s_verdict_place", 6, Radix::decimal),
                             vector("waiting", traversal + "s_verdict_waiting", 16, Radix::binary),
                             vector("leaves", traversal + "s_verdict_leaves", 16, Radix::binary),
                             vector("best", traversal + "s_verdict_best", 4, Radix::decimal)}) +
         group("7 stack",
               {bit("push", traversal + "push8"), vector("context", traversal + "context_q8", 4, Radix::decimal),
                vector("entry", traversal + "at8", 6, Radix::decimal)}) +
         group("8 leaves", {bit("valid", "m_leaf_valid"), vector("context", "m_leaf_context", 4, Radix::decimal),
                            vector("epoch", "m_leaf_epoch", 2, Radix::decimal),
                            vector("kinds B, A", "m_leaf_kinds", 4, Radix::binary), bit("result", "s_result_valid"),
                            vector("of context", "s_result_context", 4, Radix::decimal),
                            vector("hits", "s_result_hits", 3, Radix::decimal)}) +
         group("9 answer", {bit("valid", "m_done_valid"), vector("tag", "m_done_tag", 32, Radix::decimal),
                            vector("code", "m_done_code", end_names), vector("answer", "m_done_answer", answer_names),
                            vector("steps", "m_done_steps", 32, Radix::decimal)});
}

}  // namespace

void write_broad_phase_gtkw(const std::string& fst_path, std::uint64_t from, std::uint64_t to) {
  write(fst_path,
        {"cchip_broad_phase_axi", "Queries through the broad phase", view_of(from, to), broad_phase_layout()});
}

namespace {

/// A query from the ring in memory to its done record in the other one, in the order of its way.
Rows chip_layout(unsigned slot_count) {
  const int slots = static_cast<int>(slot_count);
  const std::string broad = "u_broad_phase.";
  const std::string calc = "u_calc_result.";
  return group("1 ring of queries",
               {vector("producer", "query_producer", 16, Radix::decimal),
                vector("consumer", "query_consumer", 16, Radix::decimal), bit("line wanted", "u_queries.m_read_valid"),
                bit("valid", "u_queries.m_query_valid"), bit("ready", "u_queries.m_query_ready"),
                field("tag", "u_queries.m_query_data", 512, 480, 32, Radix::decimal)}) +
         group("2 query starts", {bit("valid", "start_valid"), vector("context", "start_context", 4, Radix::decimal),
                                  vector("epoch", "start_epoch", 2, Radix::decimal)}) +
         group("3 memory, reads",
               {bit("address valid", "m_axi_arvalid"), bit("address ready", "m_axi_arready"),
                vector("address", "m_axi_araddr", 64, Radix::hexadecimal), bit("beat valid", "m_axi_rvalid"),
                vector("ID", "m_axi_rid", 6, Radix::decimal), bit("last", "m_axi_rlast")}) +
         group("4 node pairs",
               {bit("box test", broad + "u_get_data.m_pair_valid"), bit("taken next", broad + "u_get_data.m_pair_soon"),
                bit("verdict", broad + "u_traversal.s_verdict_valid"), bit("expanded", "count_step")}) +
         group("5 leaf pairs",
               {bit("valid", "leaf_valid"), vector("context", "leaf_context", 4, Radix::decimal),
                vector("kinds B, A", "leaf_kinds", 4, Radix::binary), bit("gets a number", "u_feed.m_credit"),
                vector("number", "number", 6, Radix::decimal)}) +
         group("6 transform", {bit("leaf pair", "feed_valid"), bit("taken", "feed_ready"),
                               bit("vertex", "vertex_valid"), bit("first", "vertex_first"), bit("last", "vertex_last"),
                               vector("number, pair", "pair_name", 8, Radix::hexadecimal),
                               vector("eta", "pair_err", 4, Radix::decimal)}) +
         group("7 slot", {of_slots("vertex, slot", "u_slots.vertex_valid", slots), bit("first", "u_slots.vertex_first"),
                          of_slots("result, slot", "u_slots.result_valid", slots), bit("answer", "result_valid"),
                          bit("taken", "result_ready"), field("tag", "result", 34, 0, 16, Radix::hexadecimal),
                          field("hit", "result", 34, 16, 1, Radix::binary),
                          field("definite", "result", 34, 18, 1, Radix::binary)}) +
         group("8 calcResult", {bit("leaf result", "leaf_result_valid"), bit("taken", "leaf_result_ready"),
                                bit("judged", "judged_valid"), bit("live", "judged_live"),
                                vector("tag", "judged_tag", 32, Radix::decimal),
                                vector("state", calc + "state_q", 3, Radix::decimal), bit("done", "done_valid"),
                                bit("done taken", "done_ready"), vector("its tag", "done_tag", 32, Radix::decimal)}) +
         group("9 ring of records",
               {bit("record", "record_valid"), bit("taken", "record_ready"),
                field("tag", "record", 128, 0, 32, Radix::decimal), field("done", "record", 128, 32, 1, Radix::binary),
                bit("write address", "m_axi_awvalid"), bit("response", "m_axi_bvalid"),
                vector("producer", "record_producer", 32, Radix::decimal),
                vector("consumer", "record_consumer", 32, Radix::decimal)});
}

/// What the exchange of modules adds.
Rows chip_swap_layout(unsigned slots) {
  const std::string swaps = "u_swaps.gen_swaps.";
  Rows rows = {vector("waiting, all kinds", "waiting", 21, Radix::hexadecimal),
               bit("request", swaps + "swap_valid"),
               field("slot", swaps + "swap_data", defs::swap_request_w, defs::swap_request_slot, Radix::decimal),
               field("module", swaps + "swap_data", defs::swap_request_w, defs::swap_request_module, module_names),
               vector("phase", swaps + "phase_now", phase_names),
               bit("bitstream: address", "m_axi_cfg_arvalid"),
               bit("bitstream: data", "m_axi_cfg_rvalid"),
               bit("port: write", "cfg_valid"),
               bit("report", swaps + "report_valid"),
               field("code", swaps + "report_data", defs::swap_report_w, defs::swap_report_code, swap_names)};
  for (unsigned slot = 0; slot < slots; ++slot) {
    const std::string number = std::to_string(slot);
    const std::string scope = "u_core.u_slots.gen_slots[" + number + "].u_slot.";
    rows.push_back(vector("slot " + number + ": module", scope + "rm_id", module_names));
    rows.push_back(bit("slot " + number + ": decoupled", scope + "decoupled"));
  }
  return group("10 exchange of modules", rows);
}

}  // namespace

void write_chip_gtkw(const std::string& fst_path, std::uint64_t from, std::uint64_t to, unsigned swap_slots) {
  Rows rows = chip_layout(std::max(swap_slots, 1U));
  for (Row& row : rows) {
    if (!row.name.empty()) row.name = "u_core." + row.name;
  }
  if (swap_slots != 0) rows = rows + chip_swap_layout(swap_slots);
  write(fst_path, {"cchip_chip", "Queries through the whole chip", view_of(from, to), rows});
}

void write_swap_gtkw(const std::string& fst_path, std::uint64_t from, std::uint64_t to) {
  const std::uint64_t margin = (to - from) / 20;
  const std::uint64_t first = from > margin ? from - margin : 0;
  write(fst_path, {"cchip_primtest_subsystem", "A swap of the reconfigurable subsystem", view_of(first, to + margin),
                   subsystem_layout()});
}

}  // namespace cchip
