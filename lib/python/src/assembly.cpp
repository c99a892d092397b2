// SPDX-License-Identifier: Apache-2.0
#include "assembly.hpp"

#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <cchip/assembly_motion.hpp>
#include <cchip/assembly_receipts.hpp>
#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "convert.hpp"

namespace collisionchip_python {
namespace {

using namespace nb::literals;
using cchip::Assembly;
using cchip::AssemblyPair;
using cchip::AssemblyPart;
using cchip::AssemblyRule;

const AssemblyPart& part_named(const Assembly& assembly, const std::string& name) {
  const auto found = std::find_if(assembly.parts.begin(), assembly.parts.end(),
                                  [&name](const AssemblyPart& part) { return part.name == name; });
  if (found == assembly.parts.end()) throw nb::key_error(("there is no part '" + name + "'").c_str());
  return *found;
}

AssemblyRule::Kind kind_named(const std::string& name) {
  using Kind = AssemblyRule::Kind;
  std::string all;
  for (const Kind kind :
       {Kind::nothing, Kind::touching, Kind::overlap, Kind::anything, Kind::clearance, Kind::inside, Kind::same}) {
    if (name == cchip::name_of(kind)) return kind;
    all += (all.empty() ? "" : ", ") + std::string(cchip::name_of(kind));
  }
  throw std::invalid_argument("kind is '" + name + "'; give one of " + all);
}

nb::ndarray<nb::numpy, double> row_of(const Vec3d& v) { return owned<double>({v[0], v[1], v[2]}, {3}); }

nb::ndarray<nb::numpy, double> matrix_of(const Pose& pose) {
  const Rows<double> rows = pose.matrix();
  return owned<double>(std::vector<double>(rows.data(), rows.data() + rows.size()), {4, 4});
}

/// Of a report, with what it is about: copies share the meshes.
struct Pair {
  AssemblyPair pair;
  std::string a, b, text;
  std::optional<std::string> rule;
};

struct Report {
  std::shared_ptr<const Assembly> assembly;
  cchip::AssemblyReport report;
};

Pair pair_of(const Assembly& assembly, const AssemblyPair& pair) {
  Pair result = {pair, assembly.parts[pair.a].name, assembly.parts[pair.b].name, sentence(assembly, pair), {}};
  if (pair.rule) result.rule = assembly.rules[*pair.rule].place;
  return result;
}

std::string repr_of(const Report& x) {
  return "<AssemblyReport: " + std::to_string(x.report.judged) + " pairs judged, " +
         std::to_string(x.report.violations) + " violations>";
}

Assembly load(nb::handle path, const std::string& unit, const nb::object& rules,
              const std::map<std::string, double>& joints, const nb::object& packages, const nb::object& srdf,
              bool neighbours, bool lenient) {
  const auto file = [](const nb::object& x) {
    return x.is_none() ? std::string() : nb::cast<std::string>(nb::module_::import_("os").attr("fspath")(x));
  };
  cchip::AssemblyLoadOptions options;
  options.unit = unit;
  options.rules = file(rules);
  options.joints = joints;
  options.packages = file(packages);
  options.srdf = file(srdf);
  options.neighbours = neighbours;
  options.lenient = lenient;
  const std::string name = file(nb::borrow(path));
  const nb::gil_scoped_release release;
  const GradualUnderflow mode;
  try {
    return cchip::load_assembly(name, options);
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(error.what());
  }
}

void add_part(Assembly& self, const std::string& name, nb::handle mesh, nb::handle pose,
              const std::vector<std::string>& groups) {
  const auto is_taken = [&name](const AssemblyPart& part) { return part.name == name; };
  if (std::any_of(self.parts.begin(), self.parts.end(), is_taken)) {
    throw std::invalid_argument("there is a part '" + name + "' already; give another name");
  }
  self.parts.push_back({name, to_object(mesh, "object"), one_pose(pose, "pose"), groups});
}

void add_rule(Assembly& self, const std::string& kind, const std::vector<std::string>& parts,
              const std::vector<std::string>& groups, double limit, const std::string& reason) {
  AssemblyRule rule;
  rule.kind = kind_named(kind);
  rule.parts = parts;
  rule.groups = groups;
  rule.limit = limit;
  rule.reason = reason;
  rule.place = "rule " + std::to_string(self.rules.size() + 1);
  self.rules.push_back(rule);
}

Report check(const Assembly& self, unsigned threads, std::size_t most_normals) {
  auto assembly = std::make_shared<const Assembly>(self);
  cchip::AssemblyCheckOptions options;
  options.threads = threads;
  options.most_normals = most_normals;
  const nb::gil_scoped_release release;
  const GradualUnderflow mode;
  cchip::AssemblyReport report = cchip::check(*assembly, options);
  return {std::move(assembly), std::move(report)};
}

cchip::AssemblyMotion motion_of(const std::map<std::string, std::vector<double>>& joints, const nb::dict& parts) {
  cchip::AssemblyMotion motion;
  std::size_t rows = joints.empty() ? 0 : joints.begin()->second.size();
  motion.values.resize(rows);
  for (const auto& [name, values] : joints) {
    if (values.size() != rows) {
      throw std::invalid_argument("joint '" + name + "' has " + std::to_string(values.size()) + " values, '" +
                                  joints.begin()->first + "' " + std::to_string(rows) + "; give as many for each");
    }
    motion.joints.push_back(name);
    for (std::size_t i = 0; i < rows; ++i) motion.values[i].push_back(values[i]);
  }
  for (const auto& [name, moves] : parts) {
    const std::string part = nb::cast<std::string>(name);
    const Poses poses(moves, ("the moves of part '" + part + "'").c_str(), true);
    if (!motion.parts.empty() && poses.size() != motion.moves.size()) {
      throw std::invalid_argument("part '" + part + "' has " + std::to_string(poses.size()) + " moves, others " +
                                  std::to_string(motion.moves.size()) + "; give as many for each");
    }
    motion.moves.resize(poses.size());
    motion.parts.push_back(part);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      cchip::RigidPose move;
      move.matrix() = poses[i].matrix();
      motion.moves[i].push_back(move);
    }
  }
  return motion;
}

nb::dict check_motion(const Assembly& self, const std::map<std::string, std::vector<double>>& joints,
                      const nb::dict& parts, double least_step, double rel_error, unsigned threads) {
  const cchip::AssemblyMotion motion = motion_of(joints, parts);
  cchip::MotionOptions options;
  options.threads = threads;
  options.least_step = least_step;
  options.rel_error = rel_error;
  cchip::MotionReport report;
  {
    const nb::gil_scoped_release release;
    const GradualUnderflow mode;
    report = cchip::check_motion(self, motion, options);
  }
  nb::list pairs;
  for (const cchip::MotionPair& pair : report.pairs) {
    nb::dict entry;
    entry["a"] = self.parts[pair.a].name;
    entry["b"] = self.parts[pair.b].name;
    entry["time"] = pair.time;
    entry["text"] = pair.time ? nb::cast(sentence(self, pair.violation)) : nb::none();
    entry["clearance"] = nb::make_tuple(pair.clearance_lower, pair.clearance_upper);
    nb::list unproved;
    for (const auto& [from, to] : pair.unproved) unproved.append(nb::make_tuple(from, to));
    entry["unproved"] = unproved;
    pairs.append(entry);
  }
  nb::dict result;
  result["violations"] = report.violations;
  result["unproved"] = report.unproved;
  result["pairs"] = pairs;
  result["notes"] = report.notes;
  return result;
}

nb::dict verify(const Assembly& self, nb::handle folder, unsigned threads) {
  const std::string path = nb::cast<std::string>(nb::module_::import_("os").attr("fspath")(folder));
  cchip::ReceiptReport report;
  {
    const nb::gil_scoped_release release;
    const GradualUnderflow mode;
    report = cchip::verify_receipts(self, path, threads);
  }
  nb::list pairs;
  for (const cchip::CheckedReceipt& pair : report.pairs) {
    pairs.append(nb::make_tuple(self.parts[pair.a].name, self.parts[pair.b].name, name_of(pair.state), pair.text));
  }
  nb::dict result;
  result["by_boxes"] = report.by_boxes;
  result["pairs"] = pairs;
  return result;
}

void def_report(nb::module_& m) {
  nb::class_<Pair>(m, "AssemblyPair", "Two parts of an assembly that meet, are too near or could not be judged.")
      .def_prop_ro(
          "a", [](const Pair& x) { return x.a; }, "Name of the first part.")
      .def_prop_ro(
          "b", [](const Pair& x) { return x.b; }, "Name of the second part.")
      .def_prop_ro(
          "verdict", [](const Pair& x) { return name_of(x.pair.verdict); },
          "'apart', 'too_near', 'touching', 'overlap', 'a_in_b', 'b_in_a' or 'duplicate'.")
      .def_prop_ro(
          "is_violation", [](const Pair& x) { return x.pair.is_violation; }, "Is it not as its rule wants it?")
      .def_prop_ro(
          "is_judged", [](const Pair& x) { return x.pair.is_judged; },
          "False if an open mesh or shells that overlap leave it unknown; `text` says why.")
      .def_prop_ro(
          "rule", [](const Pair& x) { return x.rule; },
          "Where the rule that counts is, 'file:line' or 'rule 1'; None: the default.")
      .def_prop_ro(
          "depth",
          [](const Pair& x) -> std::optional<double> {
            if (!x.pair.way) return std::nullopt;
            return x.pair.way->depth;
          },
          "How far B must be moved along `direction` until the parts share no volume; None if no way was found.")
      .def_prop_ro(
          "direction",
          [](const Pair& x) -> nb::object { return x.pair.way ? nb::cast(row_of(x.pair.way->direction)) : nb::none(); },
          nb::sig("def direction(self) -> numpy.typing.NDArray[numpy.float64] | None"), "(3,) float64, of length 1.")
      .def_prop_ro(
          "distance",
          [](const Pair& x) -> std::optional<std::pair<double, double>> {
            if (x.pair.verdict != cchip::PairVerdict::too_near) return std::nullopt;
            return std::pair(x.pair.distance_lower, x.pair.distance_upper);
          },
          "Of parts that are too near, bounds of their distance; otherwise None.")
      .def_prop_ro(
          "nearest",
          [](const Pair& x) -> nb::object {
            if (x.pair.verdict != cchip::PairVerdict::too_near) return nb::none();
            return nb::make_tuple(row_of(x.pair.nearest[0]), row_of(x.pair.nearest[1]));
          },
          nb::sig("def nearest(self) -> tuple[numpy.typing.NDArray[numpy.float64], "
                  "numpy.typing.NDArray[numpy.float64]] | None"),
          "Of parts that are too near, nearest points of A and B.")
      .def_prop_ro(
          "text", [](const Pair& x) { return x.text; }, "The verdict in words.")
      .def("__repr__", [](const Pair& x) { return "<AssemblyPair: " + x.text + ">"; });
  nb::class_<Report>(m, "AssemblyReport",
                     "What Assembly.check() found. True if there is no violation and all is judged.")
      .def_prop_ro(
          "judged", [](const Report& x) { return x.report.judged; }, "Pairs that were near enough to be looked at.")
      .def_prop_ro(
          "violations", [](const Report& x) { return x.report.violations; }, "How many pairs are violations.")
      .def_prop_ro(
          "accepted", [](const Report& x) { return x.report.accepted; }, "Pairs that meet, as rules accept it.")
      .def_prop_ro(
          "not_judged", [](const Report& x) { return x.report.not_judged; }, "Pairs that could not be judged.")
      .def_prop_ro(
          "pairs",
          [](const Report& x) {
            std::vector<Pair> pairs;
            for (const AssemblyPair& pair : x.report.pairs) pairs.push_back(pair_of(*x.assembly, pair));
            return pairs;
          },
          nb::sig("def pairs(self) -> list[AssemblyPair]"),
          "Pairs that meet, are too near or could not be judged, ascending.")
      .def_prop_ro(
          "unused_rules",
          [](const Report& x) {
            std::vector<std::string> texts;
            for (const std::size_t rule : x.report.unused_rules) texts.push_back(why_unused(*x.assembly, rule));
            return texts;
          },
          nb::sig("def unused_rules(self) -> list[str]"), "Of each rule that never counted, why.")
      .def_prop_ro(
          "notes", [](const Report& x) { return x.report.notes; }, nb::sig("def notes(self) -> list[str]"),
          "About parts: open meshes, sizes that differ 1,000 times.")
      .def_prop_ro(
          "size",
          [](const Report& x) {
            return owned<double>({x.report.size[0], x.report.size[1], x.report.size[2]}, {3});
          },
          nb::rv_policy::move, nb::sig("def size(self) -> numpy.typing.NDArray[numpy.float64]"),
          "(3,) float64: of the box around all parts, in units of the assembly.")
      .def(
          "accepting_rules", [](const Report& x) { return accepting_rules(*x.assembly, x.report); },
          "TOML with a rule for each pair that meets or is too near, so that only another one is a violation.")
      .def(
          "write_receipts",
          [](const Report& x, nb::handle folder, unsigned threads) {
            const std::string path = nb::cast<std::string>(nb::module_::import_("os").attr("fspath")(folder));
            const nb::gil_scoped_release release;
            const GradualUnderflow mode;
            cchip::ReceiptOptions options;
            options.threads = threads;
            cchip::write_receipts(*x.assembly, x.report, path, options);
          },
          "folder"_a, "threads"_a = 0,
          nb::sig("def write_receipts(self, folder: str | os.PathLike[str], threads: int = 0) -> None"),
          "Writes a proof of each verdict; Assembly.verify_receipts() and `cchip clash --verify` check them.")
      .def("__bool__", [](const Report& x) { return x.report.violations == 0 && x.report.not_judged == 0; })
      .def("__repr__", &repr_of);
}

}  // namespace

void def_assembly(nb::module_& m) {
  def_report(m);
  nb::class_<Assembly>(m, "Assembly", R"(Placed parts with names, and rules for what pairs of them may do.

Of the rules for a pair one counts: one that names both parts before one of two groups, that before one for all pairs;
of several that are equally special the last. A pair without any must not touch, and is at least `clearance` apart.)")
      .def(
          "__init__",
          [](Assembly* self, const std::string& unit, double clearance) {
            new (self) Assembly();
            self->unit = unit;
            self->clearance = clearance;
          },
          nb::kw_only(), "unit"_a = "", "clearance"_a = 0.0,
          "An assembly without parts. unit: um, mm, cm, m, in, ft or ''.")
      .def_static(
          "load", &load, "path"_a, nb::kw_only(), "unit"_a = "", "rules"_a = nb::none(),
          "joints"_a = std::map<std::string, double>(), "packages"_a = nb::none(), "srdf"_a = nb::none(),
          "neighbours"_a = false, "lenient"_a = false,
          nb::sig("def load(path: str | os.PathLike[str], *, unit: str = '', rules: str | os.PathLike[str] | None = "
                  "None, joints: dict[str, float] = {}, packages: str | os.PathLike[str] | None = None, srdf: str | "
                  "os.PathLike[str] | None = None, neighbours: bool = False, lenient: bool = False) -> Assembly"),
          R"(Reads a TOML file, a folder of meshes, an OBJ, glTF, GLB, 3MF or URDF, as `cchip clash` does.

Raises ValueError with one line: file, what is wrong, what to do.)")
      .def("add", &add_part, "name"_a, "object"_a.none(), "pose"_a = nb::none(), nb::kw_only(),
           "groups"_a = std::vector<std::string>(),
           nb::sig("def add(self, name: str, object: Object, pose: numpy.typing.ArrayLike | None = None, *, groups: "
                   "collections.abc.Sequence[str] = ()) -> None"),
           "Adds a part: a mesh as collide() takes it, and its pose in units of the assembly.")
      .def("add_rule", &add_rule, "kind"_a, nb::kw_only(), "parts"_a = std::vector<std::string>(),
           "groups"_a = std::vector<std::string>(), "limit"_a = 0.0, "reason"_a = "",
           nb::sig("def add_rule(self, kind: str, *, parts: collections.abc.Sequence[str] = (), groups: "
                   "collections.abc.Sequence[str] = (), limit: float = 0.0, reason: str = '') -> None"),
           R"(Adds a rule for two parts, two groups or, without either, all pairs.

kind: 'nothing', 'touching', 'overlap' (up to `limit`), 'anything' (with a reason), 'clearance' (at least `limit`),
'inside' (the first in the second) or 'same'.)")
      .def("check", &check, nb::kw_only(), "threads"_a = 0, "most_normals"_a = 100,
           R"(Looks at all pairs that are near each other or of which a rule wants something. threads: 0 for all cores.

most_normals: normals of faces in contact that are tried to find out how deep parts overlap.
Raises ValueError: a rule makes no sense, or names a part that is not there.)")
      .def(
          "check_motion", &check_motion, nb::kw_only(), "joints"_a = std::map<std::string, std::vector<double>>(),
          "parts"_a = nb::dict(), "least_step"_a = 1e-4, "rel_error"_a = 0.1, "threads"_a = 0,
          nb::sig("def check_motion(self, *, joints: dict[str, collections.abc.Sequence[float]] = {}, parts: dict[str, "
                  "numpy.typing.ArrayLike] = {}, least_step: float = 1e-4, rel_error: float = 0.1, threads: int = 0) "
                  "-> dict"),
          R"(Does it stay as the rules want it from row to row, at the times 0, 1, 2 ...? Between rows nothing is missed.

joints: of a robot, values of a row each, linear in time. parts: (n, 4, 4) rigid moves from where the assembly has the
part. Returns violations, unproved (numbers of pairs), notes, and pairs: dicts with a, b, the time of the first violation
and its text (or None), clearance (proved and found), and unproved, times from and to of which nothing is known.)")
      .def("verify_receipts", &verify, "folder"_a, nb::kw_only(), "threads"_a = 0,
           nb::sig("def verify_receipts(self, folder: str | os.PathLike[str], *, threads: int = 0) -> dict"),
           R"(Checks receipts against this assembly and its rules, without any search.

Returns by_boxes, the number of pairs that need none, and pairs, tuples (a, b, state, text); state is 'proved',
'violation', 'unproved', 'missing', 'stale' or 'refused'. Raises RuntimeError: the folder holds no receipts.)")
      .def(
          "move_joints",
          [](Assembly& self, const std::map<std::string, double>& values) { return cchip::move_joints(self, values); },
          "values"_a, nb::sig("def move_joints(self, values: dict[str, float]) -> list[str]"),
          "Moves joints of a robot, radians or metres, and returns notes. Raises ValueError, and moves none then.")
      .def_prop_ro(
          "joints",
          [](const Assembly& self) {
            std::map<std::string, double> values;
            for (const cchip::AssemblyJoint& joint : self.joints) values[joint.name] = joint.value;
            return values;
          },
          nb::sig("def joints(self) -> dict[str, float]"), "Of a robot: the value of each joint.")
      .def_prop_ro(
          "parts",
          [](const Assembly& self) {
            std::vector<std::string> names;
            for (const AssemblyPart& part : self.parts) names.push_back(part.name);
            return names;
          },
          nb::sig("def parts(self) -> list[str]"), "Names, in order.")
      .def(
          "object", [](const Assembly& self, const std::string& name) { return Object(part_named(self, name).object); },
          "name"_a, "The mesh of a part.")
      .def(
          "pose", [](const Assembly& self, const std::string& name) { return matrix_of(part_named(self, name).pose); },
          "name"_a, nb::sig("def pose(self, name: str) -> numpy.typing.NDArray[numpy.float64]"),
          "The pose of a part, (4, 4) float64, the unit of its file included.")
      .def(
          "set_pose",
          [](Assembly& self, const std::string& name, nb::handle pose) {
            const Pose place = one_pose(pose, "pose");
            self.parts[static_cast<std::size_t>(&part_named(self, name) - self.parts.data())].pose = place;
          },
          "name"_a, "pose"_a.none(),
          nb::sig("def set_pose(self, name: str, pose: numpy.typing.ArrayLike | None) -> None"), "Moves a part.")
      .def_prop_rw(
          "clearance", [](const Assembly& self) { return self.clearance; },
          [](Assembly& self, double clearance) { self.clearance = clearance; },
          "Least distance of two parts without a rule.")
      .def_prop_ro(
          "unit", [](const Assembly& self) { return self.unit; }, "Of all lengths; '' if it is not known.")
      .def_prop_ro(
          "notes", [](const Assembly& self) { return self.notes; }, nb::sig("def notes(self) -> list[str]"),
          "Of the files: what was left out.")
      .def("__len__", [](const Assembly& self) { return self.parts.size(); })
      .def("__copy__", [](const Assembly& self) { return Assembly(self); })
      .def(
          "__deepcopy__", [](const Assembly& self, nb::handle) { return Assembly(self); }, "memo"_a)
      .def("__repr__", [](const Assembly& self) {
        return "<Assembly: " + std::to_string(self.parts.size()) + " parts, " + std::to_string(self.rules.size()) +
               " rules>";
      });
}

}  // namespace collisionchip_python
