// SPDX-License-Identifier: Apache-2.0
#include "report.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <array>

namespace cchip::table1 {
namespace {

using sc_core::sc_time;

std::uint64_t picoseconds(const sc_time& time) { return time.value() / sc_time(1, sc_core::SC_PS).value(); }

/// 1234567 as 1,234,567.
std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
  return text;
}

/// Whole nanoseconds, rounded to the nearest.
std::string ns(const sc_time& time) { return grouped((picoseconds(time) + 500) / 1000); }

std::string decimal_ns(const sc_time& time) {
  const std::uint64_t ps = picoseconds(time);
  return ps % 1000 == 0 ? std::to_string(ps / 1000) : fmt::format("{}.{:03}", ps / 1000, ps % 1000);
}

std::string port_name(const rc::bit_path& port) {
  return fmt::format("{} bit, {} MHz", port.width, port.clock / 1'000'000);
}

/// What place and route made for an open fabric, and the clocks in which our controller wrote it into the latches:
/// docs/paper/fabric.md.
struct FabricBitfile {
  const char* name;
  std::uint64_t bits;
  std::uint64_t clocks;
};
constexpr std::array<FabricBitfile, 3> fabric_bitfiles = {{{"sum, 10 x 8 tiles", 28'864, 915},
                                                           {"points against triangles, 28 x 26 tiles", 432'064, 13'515},
                                                           {"two triangles, 31 x 30 tiles", 575'424, 17'995}}};

void print_fabric(std::ostream& out) {
  constexpr rc::bit_path port = {32, 50'000'000};
  fmt::print(out, "Bitfiles that place and route made for an open fabric, {}\n\n", port_name(port));
  fmt::print(out, "{:<42}{:>16}{:>12}{:>12}{:>24}\n", "Module", "bitfile [bit]", "eq. (4)", "simulated",
             "work for 0.1 % [ns]");
  for (const FabricBitfile& file : fabric_bitfiles) {
    const sc_time delay = rc::transfer_time(file.bits, port);
    fmt::print(out, "{:<42}{:>16}{:>12}{:>12}{:>24}\n", file.name, grouped(file.bits), grouped(file.bits / port.width),
               grouped(file.clocks), ns(1000 * delay));
  }
  fmt::print(out, "\nClocks. Simulated: until the last frame is in the latches, with waits for memory.\n\n");
}

void print_bitfiles(std::ostream& out) {
  const rc::bit_path& port = rc::virtex2_port;
  fmt::print(out, "Eq. (4): configuration delay of a bitfile, {} bit at {} MHz\n\n", port.width,
             port.clock / 1'000'000);
  fmt::print(out, "{:<38}{:>16}{:>16}{:>16}\n", "Design", "bitfile [bit]", "clocks", "delay [ns]");
  constexpr std::array<const char*, 2> names = {"Triangle-triangle intersection test", "Quad-quad intersection test"};
  std::uint64_t bits = 0;
  sc_time sum;
  for (std::size_t kind = 0; kind < 2; ++kind) {
    const std::uint64_t size = test_kinds[kind].bitfile_bits;
    const sc_time delay = rc::bitstream_timing().configuration(size);
    fmt::print(out, "{:<38}{:>16}{:>16}{:>16}\n", names[kind], grouped(size), grouped(size / port.width), ns(delay));
    bits += size;
    sum += delay;
  }
  fmt::print(out, "{:<38}{:>16}{:>16}{:>16}\n\n", "both, one after the other", grouped(bits),
             grouped(bits / port.width), ns(sum));
}

void print_table(const Figures& figures, std::ostream& out) {
  const sc_time& reference = figures.rows[0].counted;
  fmt::print(out, "Table 1: two triangle objects, then two quad objects\n\n");
  fmt::print(out, "{:<38}{:>16}{:>16}{:>16}{:>12}\n", "Simulation", "paper [ns]", "here [ns]", "longer [ns]",
             "longer [%]");
  constexpr std::array<std::uint64_t, 2> paper = {paper_static_ns, paper_single_bus_ns};
  for (std::size_t r = 0; r < 2; ++r) {
    const sc_time& run = figures.rows[r].counted;
    fmt::print(out, "{:<38}{:>16}{:>16}{:>16}{:>12.3f}\n", figures.rows[r].name, grouped(paper[r]), ns(run),
               ns(run - reference), percent_longer(run, reference));
  }
  const sc_time& loaded = figures.rows[1].loaded;
  fmt::print(out, "{:<38}{:>16}{:>16}{:>16}{:>12.3f}\n\n", "  triangle test loaded beforehand", "", ns(loaded),
             ns(loaded - reference), percent_longer(loaded, reference));
  fmt::print(
      out,
      "The paper does not say how much data and how many primitive pairs an object pair has. Here an object pair\n"
      "has {} bit of data, {} ns on the bus by eq. (6), an assumption; its primitive tests take {} ns,\n"
      "so that the static run takes what the paper prints. The static figure is therefore calibrated, not a\n"
      "result. The sum of eq. (5) does not depend on this division; what other platforms hide below does.\n\n",
      grouped(figures.data_bits), ns(figures.transmission), ns(figures.tests));
}

void print_contradictions(const Figures& figures, std::ostream& out) {
  const sc_time& reference = figures.rows[0].counted;
  const sc_time extra = figures.rows[1].counted - reference;
  const sc_time one = figures.rows[1].loaded - reference;
  const double needed_s = extra.to_seconds() / 0.001;
  fmt::print(out, "Where the paper contradicts itself\n\n");
  fmt::print(out,
             "- Its table prints the run with reconfiguration {} ns shorter than the one without. Eq. (5) only adds a\n"
             "  delay: the run cannot be shorter.\n",
             grouped(paper_static_ns - paper_single_bus_ns));
  fmt::print(out,
             "- Its text says that the run is less than 0.1 % longer. One configuration per object pair by eq. (4) is\n"
             "  {} ns, {:.3f} % of its static run; with the first one not counted {} ns, {:.3f} %.\n",
             ns(extra), percent_longer(reference + extra, reference), ns(one),
             percent_longer(reference + one, reference));
  fmt::print(
      out,
      "- For less than 0.1 % the static run would have to take more than {:.1f} s, {:.0f} times what is printed.\n"
      "  Were the table in microseconds, the text would hold ({:.4f} %), the order of its rows still not.\n\n",
      needed_s, needed_s / reference.to_seconds(), 0.001 * percent_longer(reference + extra, reference));
}

void print_variants(const Figures& figures, std::ostream& out) {
  const sc_time& reference = figures.rows[0].counted;
  fmt::print(out, "Variants: the same two object pairs on other platforms\n\n");
  fmt::print(out, "{:<44}{:>27}{:>27}\n", "", "first load counted", "first load not counted");
  fmt::print(out, "{:<44}{:>15}{:>12}{:>15}{:>12}\n", "Simulation", "run [ns]", "longer [%]", "run [ns]", "longer [%]");
  for (const Row& row : figures.rows) {
    fmt::print(out, "{:<44}{:>15}{:>12.3f}{:>15}{:>12.3f}\n", row.name, ns(row.counted),
               percent_longer(row.counted, reference), ns(row.loaded), percent_longer(row.loaded, reference));
  }
  fmt::print(
      out,
      "\nSingle bus: data wait while a bitstream passes, and the other way round; eq. (5) adds them up. With a path\n"
      "of its own a bitstream passes while data do. Two slots: the next test is loaded while the present one "
      "works.\n\n");
}

void print_three(const Figures& figures, std::ostream& out) {
  const sc_time& reference = figures.rows[0].three;
  fmt::print(out, "Three kinds: two triangle objects, two quad objects, then points against triangles\n\n");
  fmt::print(out, "{:<44}{:>15}{:>15}{:>12}\n", "Simulation", "run [ns]", "longer [ns]", "longer [%]");
  for (const Row& row : figures.rows) {
    const std::string name = &row == &figures.rows.front() ? "Three static primitive tests" : row.name;
    fmt::print(out, "{:<44}{:>15}{:>15}{:>12.3f}\n", name, ns(row.three), ns(row.three - reference),
               percent_longer(row.three, reference));
  }
  fmt::print(out,
             "\nThe third object pair has as much data and work as the others, and its bitfile {} bit, the mean of the "
             "two.\n\n",
             grouped(test_kinds[3].bitfile_bits));
}

void print_sensitivity(const Figures& figures, std::ostream& out) {
  fmt::print(out, "Overhead in percent of the run time without reconfiguration, by work per swap\n\n");
  fmt::print(out, "{:>12}", "");
  for (const char* slots : {"one slot", "two slots"}) fmt::print(out, "{:>48}", slots);
  fmt::print(out, "\n{:>12}", "work [ms]");
  for (int slots = 0; slots < 2; ++slots) {
    for (const rc::bit_path& port : ports) fmt::print(out, "{:>16}", port_name(port));
  }
  fmt::print(out, "\n");
  const std::size_t works = figures.points.size() / (2 * ports.size());
  std::uint64_t decade = picoseconds(figures.points[0].work);
  for (std::size_t w = 0; w < works; ++w) {
    if (picoseconds(figures.points[w].work) != decade) continue;
    decade *= 10;
    fmt::print(out, "{:>12}", 1000 * figures.points[w].work.to_seconds());
    for (std::size_t p = w; p < figures.points.size(); p += works) {
      fmt::print(out, "{:>16.5g}", percent_longer(figures.points[p].run, figures.points[p].static_run));
    }
    fmt::print(out, "\n");
  }
  fmt::print(
      out,
      "\nObject pairs of three kinds in turn, so that each needs a swap; the bitfile of the third kind is taken as "
      "the\n"
      "mean of the two, {} bit. Mean of {} swaps, data not transmitted. Two slots hide a load up to the work.\n\n",
      grouped(test_kinds[2].bitfile_bits), figures.points[0].swaps);
}

}  // namespace

void print_report(const Figures& figures, std::ostream& out) {
  print_bitfiles(out);
  print_table(figures, out);
  print_contradictions(figures, out);
  print_variants(figures, out);
  print_three(figures, out);
  print_sensitivity(figures, out);
  print_fabric(out);
  const sc_time& reference = figures.rows[0].counted;
  const sc_time& run = figures.rows[1].counted;
  fmt::print(out, "static_ns={} single_bus_ns={} overhead_percent={:.3f} paper_static_ns={} paper_single_bus_ns={}\n",
             decimal_ns(reference), decimal_ns(run), percent_longer(run, reference), paper_static_ns,
             paper_single_bus_ns);
}

void write_csv(const Figures& figures, std::ostream& out) {
  out << "slots,port_bits,port_hz,work_per_swap_ns,swaps,static_run_ns,run_ns,overhead_percent\n";
  for (const Point& point : figures.points) {
    fmt::print(out, "{},{},{},{},{},{},{},{:.6g}\n", point.slots, point.port.width, point.port.clock,
               decimal_ns(point.work), point.swaps, decimal_ns(point.static_run), decimal_ns(point.run),
               percent_longer(point.run, point.static_run));
  }
}

}  // namespace cchip::table1
