// SPDX-License-Identifier: Apache-2.0
// The machine behind UIO without a chip: what it refuses, bytes in a file, the interrupt of a UIO file.
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cchip/driver/uio_device.hpp>
#include <cerrno>
#include <cstdlib>
#include <driver/uio_interrupt.hpp>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

using namespace cchip;
using Catch::Contains;

namespace {

/// A folder with two files of zeros.
struct Files {
  Files() {
    std::string name = (std::filesystem::temp_directory_path() / "cchip_uio_XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    folder = name;
    options.registers = file("registers", 4096);
    options.memory = file("memory", 65536);
    options.memory_base = 1 << 20;
    options.memory_bytes = 65536;
  }
  ~Files() { std::filesystem::remove_all(folder); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

  std::string file(const std::string& name, std::uint64_t bytes) const {
    std::ofstream file((folder / name).string());
    file.close();
    std::filesystem::resize_file(folder / name, bytes);
    return (folder / name).string();
  }

  std::filesystem::path folder;
  UioOptions options;
};

ChipDriverOptions small_rings() {
  ChipDriverOptions driver;
  driver.query_log2 = 2;
  driver.record_log2 = 4;
  return driver;
}

}  // namespace

TEST_CASE("uio: files that are missing, too small or no chip", "[ref][uio]") {
  const Files files;
  UioOptions options = files.options;
  options.registers = (files.folder / "absent").string();
  CHECK_THROWS_WITH(open_uio_machine(options), Contains("uio: cannot open " + options.registers) &&
                                                   Contains("No such file") && Contains("is its driver loaded"));
  CHECK_THROWS_AS(open_uio_machine(options), std::runtime_error);
  options = files.options;
  options.memory = (files.folder / "absent").string();
  CHECK_THROWS_WITH(open_uio_machine(options), Contains("uio: cannot open " + options.memory));
  options = files.options;
  options.registers = files.folder.string();
  CHECK_THROWS_WITH(open_uio_machine(options), Contains("Is a directory"));
  options = files.options;
  options.registers = files.file("small", 4092);
  CHECK_THROWS_WITH(open_uio_machine(options),
                    "uio: " + options.registers + " has 4092 bytes, 4096 are needed; name another file or fewer bytes");
  options = files.options;
  options.memory_file_offset = 4096;
  CHECK_THROWS_WITH(open_uio_machine(options), Contains("has 65536 bytes, 69632 are needed"));
  options = files.options;
  options.memory = "/dev/null";  // no mapping
  CHECK_THROWS_WITH(open_uio_machine(options), Contains("cannot map 65536 bytes of /dev/null from 0") &&
                                                   Contains("No such device") && Contains("device tree"));
  CHECK_THROWS_WITH(open_uio_device(files.options, small_rings()), "chip driver: no chip, its register id is 0");
  CHECK_THROWS_WITH(open_uio_device(files.options), Contains("memory of 65536 bytes is too small"));
}

TEST_CASE("uio: options that are out of range", "[ref][uio]") {
  const Files files;
  const auto refused = [&files](auto change) {
    UioOptions options = files.options;
    change(options);
    try {
      open_uio_machine(options);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(refused([](UioOptions&) {}) == "accepted");
  CHECK(refused([](UioOptions& x) { x.registers.clear(); }) == "uio: UioOptions::registers names no file");
  CHECK(refused([](UioOptions& x) { x.memory.clear(); }) == "uio: UioOptions::memory names no file");
  CHECK_THAT(refused([](UioOptions& x) { x.register_bytes = 0; }), Contains("register_bytes is 0"));
  CHECK_THAT(refused([](UioOptions& x) { x.memory_bytes = 65535; }), Contains("memory_bytes is 65535"));
  CHECK_THAT(refused([](UioOptions& x) { x.memory_file_offset = 64; }), Contains("multiple of the page size"));
  CHECK_THAT(refused([](UioOptions& x) { x.memory_bytes = ~std::uint64_t{3}; }), Contains("ends beyond"));
  CHECK_THAT(refused([](UioOptions& x) { x.poll = std::chrono::microseconds(-1); }), Contains("poll is negative"));
}

TEST_CASE("uio: registers and memory are those of the files, and end with them", "[ref][uio]") {
  Files files;
  files.options.poll = std::chrono::microseconds(1);
  const std::unique_ptr<Machine> machine = open_uio_machine(files.options);
  machine->write_register(8, 0x04030201);
  CHECK(machine->read_register(8) == 0x04030201);
  std::string bytes(4, 0);
  std::ifstream(files.options.registers, std::ios::binary).seekg(8).read(bytes.data(), 4);
  CHECK(bytes == "\1\2\3\4");
  CHECK_THROWS_WITH(machine->read_register(4096), Contains("no 4 bytes at 4096 in the 4096 of"));
  CHECK_THROWS_WITH(machine->write_register(4096, 0), Contains("no 4 bytes at 4096"));
  CHECK_THROWS_AS(machine->read_register(2), std::runtime_error);

  const std::uint64_t base = files.options.memory_base;
  machine->write_memory(base + 65532, {1, 2, 3});  // up to the next multiple of 4
  std::ifstream(files.options.memory, std::ios::binary).seekg(65532).read(bytes.data(), 4);
  CHECK(bytes.substr(0, 3) == "\1\2\3");
  const Bytes all = machine->read_memory(base, 65536);
  CHECK(Bytes(all.end() - 4, all.end() - 1) == Bytes{1, 2, 3});
  CHECK(machine->read_memory(base + 65536, 0).empty());
  CHECK_THROWS_WITH(machine->read_memory(base - 4, 4), Contains("is before the memory"));
  CHECK_THROWS_WITH(machine->read_memory(base + 65532, 8), Contains("no 8 bytes at 65532 in the 65536"));
  CHECK_THROWS_WITH(machine->write_memory(base + 65536, {1}), Contains("no 4 bytes at 65536"));

  // no UIO file: the registers tell
  CHECK_FALSE(machine->interrupt());
  machine->write_register(0x20, 6);
  CHECK_FALSE(machine->interrupt());
  machine->write_register(0x24, 2);
  CHECK(machine->interrupt());
  machine->proceed();

  int waits = 0;
  files.options.wait = [&waits] { ++waits; };
  open_uio_machine(files.options)->proceed();
  CHECK(waits == 1);
}

// A socket as the UIO file: what the other end sends is an event, what it receives is the arming.
TEST_CASE("uio: an interrupt is reported while the line is 1, and armed when it has fallen", "[ref][uio]") {
  std::array<int, 2> ends = {};
  REQUIRE(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()) == 0);
  const auto armed = [&ends] {
    std::int32_t word = 0;
    if (recv(ends[1], &word, sizeof word, MSG_DONTWAIT) < 0) return false;
    CHECK(word == 1);
    return true;
  };
  const auto rise = [&ends] {
    const std::uint32_t count = 7;
    REQUIRE(send(ends[1], &count, sizeof count, 0) == sizeof count);
  };
  bool line = false;
  int looks = 0;
  const auto registers = [&] {
    ++looks;
    return line;
  };
  UioInterrupt interrupt(ends[0], "the socket");
  CHECK(armed());
  CHECK_FALSE(interrupt.level(registers));
  CHECK(looks == 0);  // nothing has fired
  line = true;
  rise();
  CHECK(interrupt.level(registers));
  CHECK(interrupt.level(registers));
  CHECK_FALSE(armed());
  line = false;
  CHECK_FALSE(interrupt.level(registers));
  CHECK(armed());
  looks = 0;
  CHECK_FALSE(interrupt.level(registers));
  CHECK(looks == 0);
  rise();  // and fallen before the host looks
  CHECK_FALSE(interrupt.level(registers));
  CHECK(armed());
  close(ends[1]);
  CHECK_THROWS_WITH(interrupt.level(registers), Contains("of the socket"));
  close(ends[0]);
  CHECK_THROWS_WITH(UioInterrupt(ends[0], "a closed file"), Contains("cannot arm the interrupt of a closed file"));
}
