// SPDX-License-Identifier: Apache-2.0
#include "gltf_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <utility>

#include "mesh_io/file_content.hpp"

namespace cchip::assembly {
namespace {

namespace fs = std::filesystem;

constexpr const char* anew = "; export the file anew";

/// Types of numbers by their names in glTF.
enum : std::size_t { type_byte = 5120, type_ubyte, type_short, type_ushort, type_uint = 5125, type_float };

template <class T>
T read_little(const unsigned char* from) {
  std::array<unsigned char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), from, sizeof(T));
  const std::uint16_t one = 1;
  unsigned char low = 0;
  std::memcpy(&low, &one, 1);
  if (low == 0) std::reverse(bytes.begin(), bytes.end());
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

double scaled(double value, double greatest, bool normalized) {
  return normalized ? std::max(value / greatest, -1.0) : value;
}

double number_at(const unsigned char* from, std::size_t type, bool normalized) {
  switch (type) {
    case type_byte:
      return scaled(read_little<std::int8_t>(from), 127, normalized);
    case type_ubyte:
      return scaled(read_little<std::uint8_t>(from), 255, normalized);
    case type_short:
      return scaled(read_little<std::int16_t>(from), 32767, normalized);
    case type_ushort:
      return scaled(read_little<std::uint16_t>(from), 65535, normalized);
    case type_uint:
      return scaled(read_little<std::uint32_t>(from), 4294967295.0, normalized);
    default:
      return static_cast<double>(read_little<float>(from));
  }
}

std::size_t bytes_of(std::size_t type) {
  switch (type) {
    case type_byte:
    case type_ubyte:
      return 1;
    case type_short:
    case type_ushort:
      return 2;
    case type_uint:
    case type_float:
      return 4;
    default:
      return 0;
  }
}

int hexadecimal(char c) {
  constexpr std::string_view digits = "0123456789abcdef";
  const auto at = digits.find(c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c);
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

/// A URI with its %20 as the characters they mean.
std::string decoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hexadecimal(uri[i + 1]) : -1;
    const int low = high >= 0 ? hexadecimal(uri[i + 2]) : -1;
    text += low >= 0 ? static_cast<char>(16 * high + low) : uri[i];
    if (low >= 0) i += 2;
  }
  return text;
}

/// Nothing if the text is not base64.
std::optional<std::string> from_base64(std::string_view text) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string bytes;
  std::uint32_t bits = 0;
  unsigned held = 0;
  for (const char c : text) {
    const auto digit = digits.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = (bits << 6U | static_cast<std::uint32_t>(digit)) & 0xffffU;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> held & 0xffU);
  }
  return bytes;
}

bool leaves_folder(const std::string& name) {
  const fs::path path = fs::path(name).lexically_normal();
  return name.empty() || path.has_root_path() || *path.begin() == ".." || name.find('\\') != std::string::npos ||
         name.find(':') != std::string::npos || name.find('\0') != std::string::npos;
}

}  // namespace

std::size_t GltfFile::Numbers::bytes() const { return components * bytes_of(type); }

GltfFile::GltfFile(const std::string& path, std::uint64_t most_bytes) : path_(path), allowance_(most_bytes) {
  const std::string content = mesh_io::read_file(path, "assembly");
  parse(content.compare(0, 4, "glTF") == 0 ? split_binary(content) : std::string_view(content));
  check_version();
  accessors_ = root().tables("accessors", "accessor");
  views_ = root().tables("bufferViews", "bufferView");
  buffers_ = root().tables("buffers", "buffer");
}

void GltfFile::refuse(const std::string& what) const { throw std::runtime_error(path_ + ": " + what); }

/// Keeps the binary chunk of a GLB. \returns its JSON
std::string_view GltfFile::split_binary(const std::string& content) {
  constexpr std::uint32_t json_chunk = 0x4e4f534a;
  constexpr std::uint32_t binary_chunk = 0x004e4942;
  const std::string broken = std::string("the GLB is cut off or broken") + anew;
  const auto word = [&](std::size_t at) {
    return read_little<std::uint32_t>(reinterpret_cast<const unsigned char*>(content.data()) + at);
  };
  if (content.size() < 12) refuse(broken);
  if (word(4) != 2) {
    refuse("is a GLB of version " + std::to_string(word(4)) + ", and version 2 is read; export it as glTF 2.0");
  }
  const std::size_t end = word(8);
  if (end > content.size()) refuse(broken);
  std::string_view json;
  bool has_json = false;
  for (std::size_t at = 12; at < end;) {
    if (end - at < 8) refuse(broken);
    const std::size_t size = word(at);
    const std::uint32_t kind = word(at + 4);
    if (size > end - at - 8) refuse(broken);
    if (!has_json && kind != json_chunk) refuse(broken);
    if (!has_json) json = std::string_view(content).substr(at + 8, size);
    if (has_json && !has_binary_ && kind == binary_chunk) {
      binary_ = content.substr(at + 8, size);
      has_binary_ = true;
    }
    has_json = true;
    at += 8 + size;
  }
  if (!has_json) refuse(broken);
  return json;
}

void GltfFile::parse(std::string_view text) {
  try {
    json_ = nlohmann::json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::parse_error& error) {
    refuse("is no glTF: its JSON is wrong at byte " + std::to_string(error.byte) + anew);
  } catch (const nlohmann::json::exception&) {
    refuse(std::string("is no glTF: its JSON has a number that no double holds") + anew);
  }
  if (!json_.is_object()) refuse(std::string("is no glTF: its JSON is not an object") + anew);
}

void GltfFile::check_version() const {
  const std::optional<JsonTable> asset = root().table("asset");
  const std::string version = asset ? asset->text("version") : "";
  if (version.compare(0, 2, "2.") != 0) {
    refuse(version.empty() ? "is no glTF: 'asset' names no version; export it as glTF 2.0"
                           : "is glTF " + one_line(version) + ", and 2.0 is read; export it as glTF 2.0");
  }
  const std::string least = asset->text("minVersion");
  if (!least.empty() && least != "2.0") {
    refuse("needs a reader of glTF " + one_line(least) + ", and 2.0 is read; export it as glTF 2.0");
  }
}

const JsonTable& GltfFile::member(const std::vector<JsonTable>& list, std::size_t number, const char* what,
                                  const std::string& who) const {
  if (number < list.size()) return list[number];
  refuse(who + ": names " + what + " " + std::to_string(number) + ", and there are " + std::to_string(list.size()) +
         anew);
}

void GltfFile::spend(std::uint64_t count, std::uint64_t bytes_each, const std::string& who) {
  if (allowance_.spend(count, bytes_each)) return;
  refuse(who + ": takes more memory than the file may ask for; split the file, or raise most_unpacked_bytes");
}

std::string GltfFile::load_buffer(std::size_t number) const {
  const JsonTable& buffer = buffers_[number];
  const std::string uri = buffer.text("uri");
  if (uri.empty()) {
    const std::string extensions = buffer.extensions();
    buffer.refuse((extensions.empty() ? "has no data" : "has no data that is read, only that of " + extensions) +
                  std::string(anew));
  }
  if (uri.compare(0, 5, "data:") == 0) {
    const auto comma = uri.find(',');
    const bool good = comma != std::string::npos && comma >= 7 && uri.compare(comma - 7, 7, ";base64") == 0;
    std::optional<std::string> bytes;
    if (good) bytes = from_base64(std::string_view(uri).substr(comma + 1));
    if (!bytes) buffer.refuse(std::string("its data URI is not base64") + anew);
    return *bytes;
  }
  const std::string name = decoded(uri);
  if (leaves_folder(name)) {
    buffer.refuse("'" + one_line(name) + "' is not in the folder of the file; put it there, or export a GLB");
  }
  const std::string beside = (fs::path(path_).parent_path() / name).string();
  try {
    return mesh_io::read_file(beside, "buffer");
  } catch (const std::runtime_error& error) {
    buffer.refuse(error.what());
  }
}

std::string_view GltfFile::buffer(std::size_t number, const std::string& who) {
  const JsonTable& buffer = member(buffers_, number, "buffer", who);
  const std::size_t length = buffer.required_whole("byteLength");
  std::string_view bytes;
  if (number == 0 && has_binary_ && !buffer.has("uri")) {
    bytes = binary_;
  } else {
    auto found = loaded_.find(number);
    if (found == loaded_.end()) found = loaded_.emplace(number, load_buffer(number)).first;
    bytes = found->second;
  }
  if (bytes.size() < length) {
    buffer.refuse("has " + std::to_string(bytes.size()) + " bytes, and says " + std::to_string(length) + anew);
  }
  return bytes.substr(0, length);
}

/// The first of `count` elements of a bufferView. \param from what has the view's number and a byteOffset
GltfFile::Elements GltfFile::elements(const JsonTable& from, std::size_t view, std::size_t count,
                                      std::size_t bytes_each) {
  const JsonTable& range = member(views_, view, "bufferView", from.who());
  const std::string_view bytes = buffer(range.required_whole("buffer"), range.who());
  const std::size_t first = range.whole("byteOffset", 0);
  const std::size_t length = range.required_whole("byteLength");
  if (first > bytes.size() || length > bytes.size() - first) {
    range.refuse(std::string("reaches beyond its buffer") + anew);
  }
  const std::size_t stride = range.whole("byteStride", bytes_each);
  if (stride < bytes_each || stride > 1024) range.refuse(std::string("'byteStride' does not fit the data") + anew);
  const std::size_t offset = from.whole("byteOffset", 0);
  const bool fits =
      offset <= length &&
      (count == 0 || (bytes_each <= length - offset && (count - 1) <= (length - offset - bytes_each) / stride));
  if (!fits) from.refuse(std::string("reaches beyond its bufferView") + anew);
  return {reinterpret_cast<const unsigned char*>(bytes.data()) + first + offset, stride};
}

void GltfFile::check_type(const JsonTable& accessor, const Numbers& numbers, Use use) const {
  const std::size_t type = numbers.type;
  if (bytes_of(type) == 0) {
    accessor.refuse("'componentType' " + std::to_string(type) + " is none of glTF" + anew);
  }
  const std::string wanted = numbers.components == 1 ? "SCALAR" : "VEC" + std::to_string(numbers.components);
  if (accessor.text("type") != wanted) accessor.refuse("'type' must be " + wanted + anew);
  const bool is_unsigned = type == type_ubyte || type == type_ushort || type == type_uint;
  if (use == Use::indices && (!is_unsigned || numbers.normalized)) {
    accessor.refuse(std::string("indices must be unsigned integers") + anew);
  }
  const bool is_small = type >= type_byte && type <= type_ushort;
  if (use == Use::floats && type != type_float && !(is_small && numbers.normalized)) {
    accessor.refuse(std::string("must hold floats or normalized integers of 8 or 16 bits") + anew);
  }
  if (use == Use::numbers && type != type_float && !is_small) {
    accessor.refuse(std::string("must hold floats or integers of 8 or 16 bits") + anew);
  }
}

std::vector<double> GltfFile::accessor(std::size_t number, std::size_t components, Use use, const std::string& who) {
  const JsonTable& accessor = member(accessors_, number, "accessor", who);
  const Numbers numbers = {accessor.required_whole("componentType"), accessor.flag("normalized", false), components};
  check_type(accessor, numbers, use);
  const std::size_t count = accessor.required_whole("count");
  spend(count, components * sizeof(double), accessor.who());
  std::vector<double> values;
  if (const std::optional<std::size_t> view = accessor.whole("bufferView")) {
    const Elements from = elements(accessor, *view, count, numbers.bytes());
    values.reserve(count * components);
    for (std::size_t i = 0; i < count * components; ++i) {
      const unsigned char* place = from.first + i / components * from.stride + i % components * bytes_of(numbers.type);
      values.push_back(number_at(place, numbers.type, numbers.normalized));
    }
  } else {
    values.assign(count * components, 0.0);
  }
  put_sparse(accessor, count, numbers, values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      accessor.refuse("element " + std::to_string(i / components) + " is not a finite number" + anew);
    }
  }
  return values;
}

void GltfFile::put_sparse(const JsonTable& accessor, std::size_t count, const Numbers& numbers,
                          std::vector<double>& values) {
  const std::optional<JsonTable> sparse = accessor.table("sparse");
  if (!sparse) return;
  const std::optional<JsonTable> where = sparse->table("indices");
  const std::optional<JsonTable> what = sparse->table("values");
  if (!where || !what) sparse->refuse(std::string("'indices' or 'values' is missing") + anew);
  const std::size_t some = sparse->required_whole("count");
  const std::size_t type = where->required_whole("componentType");
  if (type != type_ubyte && type != type_ushort && type != type_uint) {
    where->refuse(std::string("indices must be unsigned integers") + anew);
  }
  const Elements places = elements(*where, where->required_whole("bufferView"), some, bytes_of(type));
  const Elements changed = elements(*what, what->required_whole("bufferView"), some, numbers.bytes());
  for (std::size_t i = 0; i < some; ++i) {
    const auto place = static_cast<std::size_t>(number_at(places.first + i * places.stride, type, false));
    if (place >= count) {
      where->refuse("names element " + std::to_string(place) + ", and there are " + std::to_string(count) + anew);
    }
    for (std::size_t k = 0; k < numbers.components; ++k) {
      const unsigned char* from = changed.first + i * changed.stride + k * bytes_of(numbers.type);
      values[place * numbers.components + k] = number_at(from, numbers.type, numbers.normalized);
    }
  }
}

}  // namespace cchip::assembly
