// SPDX-License-Identifier: Apache-2.0
#include <cchip/certificate_file.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cstddef>
#include <istream>
#include <numeric>
#include <ostream>
#include <stdexcept>
#ifdef CCHIP_WITH_JSON
#include <nlohmann/json.hpp>
#endif

namespace cchip {
namespace {

using CellKind = CertificateCell::Kind;
constexpr std::array<const char*, 7> kind_names = {"split_a", "split_b", "separated", "meet", "touch", "cross", "near"};
constexpr std::array<const char*, 3> relation_names = {"apart", "touching", "crossing"};

std::string hash_text(std::uint64_t hash) {
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[i] = "0123456789abcdef"[hash >> (60 - 4 * i) & 15U];
  return '"' + text + '"';
}

std::string relation_text(const std::optional<Relation>& relation) {
  return relation ? '"' + std::string(relation_names[static_cast<std::size_t>(*relation)]) + '"' : "null";
}

/// Strings: the numbers are longer than those of JSON's readers.
std::string list(const std::vector<Digits>& numbers) {
  std::string text;
  for (const Digits& number : numbers) text += (text.empty() ? "[\"" : ",\"") + number + '"';
  return text + ']';
}

std::string list(const std::vector<std::uint32_t>& numbers) {
  std::string text;
  for (const std::uint32_t number : numbers) text += (text.empty() ? "[" : ",") + std::to_string(number);
  return text.empty() ? "[]" : text + ']';
}

/// Numbers, and [first, last] for three and more that ascend by one.
std::string list_of_runs(const std::vector<std::uint32_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i + 1;
    while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
    if (end - i < 3) end = i + 1;
    text += text.empty() ? '[' : ',';
    text += end == i + 1 ? std::to_string(numbers[i])
                         : '[' + std::to_string(numbers[i]) + ',' + std::to_string(numbers[end - 1]) + ']';
    i = end;
  }
  return text.empty() ? "[]" : text + ']';
}

}  // namespace

void write_certificate(const Certificate& certificate, std::ostream& out) {
  const Certificate& c = certificate;
  std::string text = "{\"collisionchip_certificate\":" + std::to_string(c.version);
  text += ",\"mesh_a\":" + hash_text(c.hash_a) + ",\"mesh_b\":" + hash_text(c.hash_b);
  text += ",\"poses\":" + hash_text(c.hash_poses) + ",\"all\":" + (c.all ? "true" : "false");
  if (c.within > 0) text += (c.below ? ",\"below\":" : ",\"within\":") + decimal_text(c.within);
  if (c.along) {
    for (int i = 0; i < 3; ++i) text += (i == 0 ? ",\"along\":[" : ",") + decimal_text((*c.along)[i]);
    text += ']';
  }
  text += ",\"least\":" + relation_text(c.least) + ",\"relation\":" + relation_text(c.relation) + ",\"contacts\":[";
  const char* comma = "";
  for (const Certificate::Contact& contact : c.contacts) {
    text += comma + ('[' + std::to_string(contact.face_a)) + ',' + std::to_string(contact.face_b) + ',' +
            relation_text(contact.relation) + ']';
    comma = ",";
  }
  text += ']';
  if (c.version == 3) {
    text += ",\"tree_a\":" + hash_text(c.tree_a) + ",\"tree_b\":" + hash_text(c.tree_b);
  } else {
    text += ",\"order_a\":" + list_of_runs(c.order_a) + ",\"order_b\":" + list_of_runs(c.order_b);
  }
  out << text << "}\n";
  for (const CertificateCell& cell : c.cells) {
    text = std::string("{\"cell\":\"") + kind_names[static_cast<std::size_t>(cell.kind)] + '"';
    if (cell.kind <= CellKind::split_b && c.version != 3) text += ",\"at\":" + std::to_string(cell.at);
    if (cell.kind >= CellKind::meet) {
      text += ",\"faces\":" + list(std::vector<std::uint32_t>{cell.face_a, cell.face_b});
      text += ",\"a\":" + list(cell.weights_a) + ",\"b\":" + list(cell.weights_b);
    }
    if (cell.kind == CellKind::separated || cell.kind == CellKind::touch) {
      text += ",\"direction\":" + list(cell.direction);
    }
    if (cell.kind == CellKind::cross) {
      text += ",\"span\":[";
      for (std::size_t i = 0; i < 3; ++i) {
        text += (i > 0 ? ",\"" : "\"") + std::string(cell.span[i].of_b ? "b" : "a") +
                std::to_string(cell.span[i].vertex) + '"';
      }
      text += ']';
    }
    out << text << "}\n";
  }
}

void write_certificate_tree(const CertificateTree& tree, std::ostream& out) {
  out << "{\"collisionchip_tree\":1,\"mesh\":" << hash_text(tree.hash()) << ",\"order\":" << list_of_runs(tree.order())
      << "}\n";
}

#ifdef CCHIP_WITH_JSON
namespace {

using nlohmann::json;

void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

/// JSON's errors show what was read up to them, which may be megabytes.
std::string shortened(const std::string& text) {
  std::size_t end = 200;
  if (text.size() <= end) return text;
  while ((static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U && end > 0) --end;  // not within a letter
  return text.substr(0, end) + "...";
}

/// A line of JSON; one that nests deeper than lines of certificates do is refused before it costs a stack.
json parse(const std::string& line) {
  require(line.rfind("\xef\xbb\xbf", 0) != 0, "a byte order mark");  // which JSON's reader skips
  const auto flat = [](int depth, json::parse_event_t /*event*/, json& /*value*/) {
    require(depth <= 4, "too deep");
    return true;
  };
  return json::parse(line, flat);
}

template <std::size_t count>
std::size_t index_of(const std::array<const char*, count>& names, const json& value) {
  const auto& text = value.get_ref<const std::string&>();
  for (std::size_t i = 0; i < count; ++i) {
    if (text == names[i]) return i;
  }
  throw std::runtime_error("unknown word");
}

std::uint32_t number(const json& value) {
  require(value.is_number_unsigned() && value.get<std::uint64_t>() <= 0xffffffffU, "not a number below 2^32");
  return value.get<std::uint32_t>();
}

std::vector<std::uint32_t> numbers(const json& value) {
  require(value.is_array(), "not a list");
  std::vector<std::uint32_t> result;
  for (const json& entry : value) result.push_back(number(entry));
  return result;
}

std::vector<Digits> integers(const json& value) {
  std::vector<Digits> result = value.get<std::vector<Digits>>();
  for (const Digits& text : result) require(is_integer(text), "not an integer of at most 20000 digits");
  return result;
}

/// What list_of_runs() writes. A run is a few bytes for any number of faces, so that is limited.
std::vector<std::uint32_t> numbers_of_runs(const json& value) {
  constexpr std::uint64_t most = std::uint64_t{1} << 24U;
  require(value.is_array(), "not a list");
  std::vector<std::uint32_t> result;
  for (const json& entry : value) {
    require(!entry.is_array() || entry.size() == 2, "a run is the first and the last number");
    const std::uint64_t first = number(entry.is_array() ? entry[0] : entry);
    const std::uint64_t last = number(entry.is_array() ? entry[1] : entry);
    require(first <= last && last - first + result.size() < most, "an order of more than 2^24 faces, or a run back");
    // At once: a file of a few hundred bytes may name millions of faces.
    result.resize(result.size() + (last - first + 1));
    std::iota(result.end() - static_cast<std::ptrdiff_t>(last - first + 1), result.end(),
              static_cast<std::uint32_t>(first));
  }
  return result;
}

std::optional<Relation> relation(const json& value) {
  if (value.is_null()) return std::nullopt;
  return static_cast<Relation>(index_of(relation_names, value));
}

std::uint64_t hash(const json& value) {
  const auto& text = value.get_ref<const std::string&>();
  require(text.size() == 16, "a hash has 16 digits");
  std::uint64_t result = 0;
  for (const char digit : text) {
    const std::size_t place = std::string("0123456789abcdef").find(digit);
    require(place < 16, "a hash has digits 0-9, a-f");
    result = result << 4U | place;
  }
  return result;
}

Certificate read_claim(const json& line) {
  Certificate c;
  const json& version = line.at("collisionchip_certificate");
  require(version.is_number_unsigned() && (version == 1 || version == 2 || version == 3),
          "no certificate, or another version of it");
  c.version = version.get<int>();
  c.hash_a = hash(line.at("mesh_a"));
  c.hash_b = hash(line.at("mesh_b"));
  c.hash_poses = hash(line.at("poses"));
  c.all = line.at("all").get<bool>();
  c.least = static_cast<Relation>(index_of(relation_names, line.at("least")));
  for (const bool below : {false, true}) {
    const char* const key = below ? "below" : "within";
    if (!line.contains(key)) continue;
    require(c.within == 0 && line.at(key).is_number(), "no distance, or two");
    c.within = line.at(key).get<double>();
    c.below = below;
    require(c.within > 0, "a distance is above 0");
  }
  if (line.contains("along")) {
    const json& along = line.at("along");
    require(along.is_array() && along.size() == 3, "a translation has three numbers");
    c.along = Vec3d::Zero();
    for (int i = 0; i < 3; ++i) {
      require(along[static_cast<std::size_t>(i)].is_number(), "a translation has three numbers");
      (*c.along)[i] = along[static_cast<std::size_t>(i)].get<double>();
    }
  }
  c.relation = relation(line.at("relation"));
  require(line.at("contacts").is_array(), "contacts are no list");
  for (const json& contact : line.at("contacts")) {
    require(contact.is_array() && contact.size() == 3, "a contact is two faces and a relation");
    c.contacts.push_back({number(contact[0]), number(contact[1]), relation(contact[2])});
  }
  if (c.version == 3) {
    require(!line.contains("order_a") && !line.contains("order_b"), "an order beside a tree");
    c.tree_a = hash(line.at("tree_a"));
    c.tree_b = hash(line.at("tree_b"));
  } else {
    c.order_a = numbers_of_runs(line.at("order_a"));
    c.order_b = numbers_of_runs(line.at("order_b"));
  }
  return c;
}

CertificateCell read_cell(const json& line, bool is_of_trees) {
  CertificateCell cell;
  cell.kind = static_cast<CellKind>(index_of(kind_names, line.at("cell")));
  if (cell.kind <= CellKind::split_b && !is_of_trees) cell.at = number(line.at("at"));
  if (cell.kind >= CellKind::meet) {
    const std::vector<std::uint32_t> faces = numbers(line.at("faces"));
    require(faces.size() == 2, "a point needs two faces");
    cell.face_a = faces[0];
    cell.face_b = faces[1];
    cell.weights_a = integers(line.at("a"));
    cell.weights_b = integers(line.at("b"));
  }
  if (cell.kind == CellKind::separated || cell.kind == CellKind::touch) cell.direction = integers(line.at("direction"));
  if (cell.kind == CellKind::cross) {
    const json& span = line.at("span");
    require(span.is_array() && span.size() == 3, "a span is three edges");
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& edge = span[i].get_ref<const std::string&>();
      require(edge.size() == 2 && (edge[0] == 'a' || edge[0] == 'b') && edge[1] >= '1' && edge[1] <= '3',
              "an edge is a1 to a3 or b1 to b3");
      cell.span[i] = {edge[0] == 'b', static_cast<std::uint8_t>(edge[1] - '0')};
    }
  }
  return cell;
}

}  // namespace

std::optional<Certificate> CertificateReader::next() {
  const auto read_line = [this] {
    ++number_;
    ended_ = !std::getline(in_, line_);
    if (in_.bad()) throw std::runtime_error("cannot be read");
    return !ended_;
  };
  try {
    if (number_ == 0) read_line();
    if (ended_) return std::nullopt;
    Certificate certificate = read_claim(parse(line_));
    while (read_line()) {
      const json line = parse(line_);
      if (line.is_object() && line.contains("collisionchip_certificate")) break;  // of the next one
      certificate.cells.push_back(read_cell(line, certificate.version == 3));
    }
    return certificate;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // JSON's errors too
    throw std::runtime_error("certificate, line " + std::to_string(number_) + ": " + shortened(error.what()));
  }
}
CertificateTree read_certificate_tree(const Mesh& mesh, std::istream& in) {
  const auto refuse = [](const std::string& why) { throw std::runtime_error("tree: " + why); };
  std::string text;
  if (!std::getline(in, text)) refuse("the file is empty or cannot be read");
  if (in.peek() != std::istream::traits_type::eof()) refuse("more than one line");
  try {
    const json line = parse(text);
    require(line.at("collisionchip_tree") == 1, "no tree, or another version of it");
    CertificateTree tree(mesh, numbers_of_runs(line.at("order")));
    require(hash(line.at("mesh")) == tree.hash(), "it is of another mesh");
    return tree;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse(shortened(error.what()));
    throw;
  }
}
#else
namespace {

[[noreturn]] void refuse_without_json() {
  throw std::runtime_error("certificate: this library was built without nlohmann-json; build it with");
}

}  // namespace

std::optional<Certificate> CertificateReader::next() { refuse_without_json(); }
CertificateTree read_certificate_tree(const Mesh& /*mesh*/, std::istream& /*in*/) { refuse_without_json(); }
#endif

Certificate read_certificate(std::istream& in) {
  CertificateReader reader(in);
  std::optional<Certificate> certificate = reader.next();
  if (!certificate) throw std::runtime_error("certificate, line 1: the file is empty");
  if (reader.next()) throw std::runtime_error("certificate: the file holds more than one; use CertificateReader");
  return *std::move(certificate);
}

}  // namespace cchip
