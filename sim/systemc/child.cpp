// SPDX-License-Identifier: Apache-2.0
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cchip/levels/level.hpp>
#include <cerrno>
#include <cstring>
#include <exception>
#include <iostream>
#include <stdexcept>

namespace cchip::levels {
namespace {

/// What the child writes to the pipe: the fixed part, and the answers or a message.
struct Header {
  bool ok = false;
  std::uint64_t bytes = 0;
  std::uint64_t swaps = 0;
  double simulated_seconds = 0;
  double wall_seconds = 0;
  std::uint64_t deltas = 0;
};

void write_all(int pipe, const void* data, std::size_t bytes) {
  const char* from = static_cast<const char*>(data);
  while (bytes != 0) {
    const ssize_t done = write(pipe, from, bytes);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) _exit(1);  // the parent is gone
    from += done;
    bytes -= static_cast<std::size_t>(done);
  }
}

/// False at the end of the stream.
bool read_all(int pipe, void* data, std::size_t bytes) {
  char* to = static_cast<char*>(data);
  while (bytes != 0) {
    const ssize_t done = read(pipe, to, bytes);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    to += done;
    bytes -= static_cast<std::size_t>(done);
  }
  return true;
}

[[noreturn]] void work(int pipe, const std::function<LevelResult()>& job) {
  Header header;
  std::vector<std::uint8_t> payload;
  try {
    const LevelResult result = job();
    header = {true, result.answers.size(), result.swaps, result.simulated_seconds, result.wall_seconds, result.deltas};
    payload = result.answers;
  } catch (const std::exception& error) {
    const std::string message = error.what();
    payload.assign(message.begin(), message.end());
    header.bytes = payload.size();
  }
  write_all(pipe, &header, sizeof(header));
  write_all(pipe, payload.data(), payload.size());
  std::cout.flush();
  _exit(0);  // not exit(): destructors of the parent's objects are the parent's
}

}  // namespace

LevelResult in_child(const std::function<LevelResult()>& job) {
  std::array<int, 2> pipe_ends{};
  if (pipe(pipe_ends.data()) != 0) throw std::runtime_error("no pipe: " + std::string(std::strerror(errno)));
  std::cout.flush();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no child process: " + std::string(std::strerror(errno)));
  if (child == 0) {
    close(pipe_ends[0]);
    work(pipe_ends[1], job);
  }
  close(pipe_ends[1]);
  Header header;
  std::vector<std::uint8_t> payload;
  bool whole = read_all(pipe_ends[0], &header, sizeof(header));
  if (whole) {
    payload.resize(header.bytes);
    whole = read_all(pipe_ends[0], payload.data(), payload.size());
  }
  close(pipe_ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!whole) {
    throw std::runtime_error(WIFSIGNALED(status)
                                 ? std::string("simulation ended by signal ") + strsignal(WTERMSIG(status))
                                 : "simulation ended without a result");
  }
  if (!header.ok) throw std::runtime_error(std::string(payload.begin(), payload.end()));
  return {std::move(payload), header.swaps, header.simulated_seconds, header.wall_seconds, header.deltas};
}

}  // namespace cchip::levels
