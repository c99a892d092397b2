// SPDX-License-Identifier: Apache-2.0
/*
 * Registers, memory and interrupt of cchip_chip behind files of Linux. A call that a file refuses, or does in part, is
 * CHIP_LOST: a card that has left the bus refuses or reads as all ones, and chip_poll.c knows those.
 */
#define _GNU_SOURCE /* ppoll() */
#define _FILE_OFFSET_BITS 64
#include "chip_linux.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <time.h>
#include <unistd.h>

enum { REGISTER_BYTES = 4096 };

static uint64_t now(void* context) {
  struct timespec t;
  (void)context;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (uint64_t)t.tv_sec * 1000000 + (uint64_t)t.tv_nsec / 1000;
}

/* ---- files that are read and written */

static int read_all(int file, void* to, size_t bytes, uint64_t offset) {
  for (size_t done = 0; done < bytes;) {
    const ssize_t n = pread(file, (char*)to + done, bytes - done, (off_t)(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return CHIP_LOST;
    done += (size_t)n;
  }
  return CHIP_OK;
}

static int write_all(int file, const void* from, size_t bytes, uint64_t offset) {
  for (size_t done = 0; done < bytes;) {
    const ssize_t n = pwrite(file, (const char*)from + done, bytes - done, (off_t)(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return CHIP_LOST;
    done += (size_t)n;
  }
  return CHIP_OK;
}

static int is_inside(const struct chip_linux* l, uint32_t offset, uint32_t bytes) {
  return offset % 4 == 0 && offset <= l->bytes && bytes <= l->bytes - offset;
}

static int file_read32(void* context, uint32_t offset, uint32_t* value) {
  const struct chip_linux* l = context;
  return read_all(l->registers, value, 4, offset);
}
static int file_write32(void* context, uint32_t offset, uint32_t value) {
  const struct chip_linux* l = context;
  return write_all(l->registers, &value, 4, offset);
}
static int file_read(void* context, uint32_t offset, void* to, uint32_t bytes) {
  const struct chip_linux* l = context;
  return is_inside(l, offset, bytes) ? read_all(l->from_card, to, bytes, l->address + offset) : CHIP_LOST;
}
static int file_write(void* context, uint32_t offset, const void* from, uint32_t bytes) {
  const struct chip_linux* l = context;
  return is_inside(l, offset, bytes) ? write_all(l->to_card, from, bytes, l->address + offset) : CHIP_LOST;
}

/* ---- mappings */

/* Accesses before it are done, for the chip too, before those after it. */
static void order(void) {
  atomic_thread_fence(memory_order_seq_cst);
#if defined(__aarch64__) || defined(__arm__)
  __asm__ volatile("dsb sy" ::: "memory");
#elif defined(__riscv)
  __asm__ volatile("fence iorw, iorw" ::: "memory");
#endif
}

static int mapped_read32(void* context, uint32_t offset, uint32_t* value) {
  const struct chip_linux* l = context;
  *value = l->register_words[offset / 4];
  order();
  return CHIP_OK;
}
static int mapped_write32(void* context, uint32_t offset, uint32_t value) {
  const struct chip_linux* l = context;
  order();
  l->register_words[offset / 4] = value;
  return CHIP_OK;
}
/* Aligned words only: uncached mappings of some hosts bear nothing else. */
static int mapped_read(void* context, uint32_t offset, void* to, uint32_t bytes) {
  const struct chip_linux* l = context;
  if (!is_inside(l, offset, bytes)) return CHIP_LOST;
  for (uint32_t i = 0; i < bytes / 4; ++i) {
    const uint32_t word = l->memory_words[offset / 4 + i];
    memcpy((char*)to + 4 * i, &word, 4);
  }
  order();
  return CHIP_OK;
}
static int mapped_write(void* context, uint32_t offset, const void* from, uint32_t bytes) {
  const struct chip_linux* l = context;
  if (!is_inside(l, offset, bytes)) return CHIP_LOST;
  for (uint32_t i = 0; i < bytes / 4; ++i) {
    uint32_t word;
    memcpy(&word, (const char*)from + 4 * i, 4);
    l->memory_words[offset / 4 + i] = word;
  }
  return CHIP_OK;
}

/* ---- interrupt */

/* UIO masks an interrupt that it reports; XDMA counts. Either file is readable once one has come. Without a file this
 * sleeps a while, so that the caller polls. */
static int wait_event(void* context, uint32_t microseconds) {
  const struct chip_linux* l = context;
  const uint64_t start = now(context);
  const int32_t on = 1;
  if (l->events >= 0 && l->arms && write(l->events, &on, sizeof on) != sizeof on) return CHIP_LOST;
  for (;;) {
    const uint64_t passed = now(context) - start;
    uint64_t left = passed < microseconds ? microseconds - passed : 0;
    if (l->events < 0 && left > 50) left = 50;
    const struct timespec limit = {(time_t)(left / 1000000), (long)(left % 1000000 * 1000)};
    struct pollfd file = {l->events, POLLIN, 0}; /* -1 is passed over */
    const int ready = ppoll(&file, 1, &limit, NULL);
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) return CHIP_TIMEOUT;
    if (ready < 0 || !(file.revents & POLLIN)) return CHIP_LOST;
    uint32_t count;
    const ssize_t n = read(l->events, &count, sizeof count);
    if (n == sizeof count) return CHIP_OK;
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    return CHIP_LOST;
  }
}

/* ---- opening */

static volatile uint32_t* map(int file, uint32_t bytes, uint64_t offset) {
  void* at = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, (off_t)offset);
  return at == MAP_FAILED ? NULL : at;
}

static int begin(struct chip_linux* l, uint32_t bytes) {
  memset(l, 0, sizeof *l);
  l->registers = l->events = l->to_card = l->from_card = -1;
  l->bytes = bytes;
  l->port.context = l;
  l->port.wait = wait_event;
  l->port.now = now;
  if (bytes % 4 == 0 && bytes >= CHIP_IMAGES) return 0;
  errno = EINVAL;
  return 1;
}

static int end(struct chip_linux* l, int failed) {
  const int why = errno;
  if (failed) chip_close(l);
  errno = why;
  return failed;
}

/* Not every file of registers: a 1 written to /dev/mem would change memory. */
static int is_uio(int file) {
  struct stat status;
  char link[64], to[256];
  if (fstat(file, &status) != 0 || !S_ISCHR(status.st_mode)) return 0;
  snprintf(link, sizeof link, "/sys/dev/char/%u:%u/subsystem", major(status.st_rdev), minor(status.st_rdev));
  const ssize_t n = readlink(link, to, sizeof to);
  return n >= 4 && memcmp(to + n - 4, "/uio", 4) == 0;
}

int chip_open_uio(struct chip_linux* l, const char* registers, const char* memory, uint64_t offset, uint32_t bytes) {
  if (begin(l, bytes)) return 1;
  l->port.read32 = mapped_read32;
  l->port.write32 = mapped_write32;
  l->port.read = mapped_read;
  l->port.write = mapped_write;
  l->arms = 1;
  l->registers = open(registers, O_RDWR | O_CLOEXEC | O_SYNC);
  if (l->registers < 0) return 1;
  l->register_words = map(l->registers, REGISTER_BYTES, 0);
  if (is_uio(l->registers)) l->events = l->registers;
  const int file = open(memory, O_RDWR | O_CLOEXEC | O_SYNC); /* u-dma-buf, /dev/mem: an uncached mapping on Arm */
  if (file >= 0) l->memory_words = map(file, bytes, offset);
  const int why = errno;
  if (file >= 0) close(file);
  errno = why;
  return end(l, !l->register_words || !l->memory_words);
}

static int open_one(const char* name, const char* suffix, int flags) {
  char path[256];
  const int n = snprintf(path, sizeof path, "%s%s", name, suffix);
  if (n < 0 || (size_t)n >= sizeof path) {
    errno = ENAMETOOLONG;
    return -1;
  }
  return open(path, flags | O_CLOEXEC);
}

int chip_open_xdma(struct chip_linux* l, const char* name, uint64_t address, uint32_t bytes) {
  if (begin(l, bytes)) return 1;
  l->port.read32 = file_read32;
  l->port.write32 = file_write32;
  l->port.read = file_read;
  l->port.write = file_write;
  l->address = address;
  l->registers = open_one(name, "_user", O_RDWR);
  if (l->registers < 0) return 1;
  l->to_card = open_one(name, "_h2c_0", O_WRONLY);
  if (l->to_card >= 0) l->from_card = open_one(name, "_c2h_0", O_RDONLY);
  if (l->from_card < 0) return end(l, 1);
  l->events = open_one(name, "_events_0", O_RDONLY);
  return end(l, l->events < 0 && errno != ENOENT);
}

void chip_close(struct chip_linux* l) {
  if (l->register_words) munmap((void*)l->register_words, REGISTER_BYTES);
  if (l->memory_words) munmap((void*)l->memory_words, l->bytes);
  if (l->events >= 0 && l->events != l->registers) close(l->events);
  if (l->registers >= 0) close(l->registers);
  if (l->to_card >= 0) close(l->to_card);
  if (l->from_card >= 0) close(l->from_card);
  l->registers = l->events = l->to_card = l->from_card = -1;
  l->register_words = l->memory_words = NULL;
}
