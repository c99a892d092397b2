// SPDX-License-Identifier: Apache-2.0
/*
 * The driver in C over the files of a card. Behind them is a chip of a few lines: registers, rings, an interrupt, and a
 * memory that sees a record as two beats of 64 bits. Over XDMA it answers pread() and pwrite() of the driver, also with
 * faults; over UIO it shares mapped files with the driver, from a thread. Over VFIO the calls of the kernel are played,
 * too: each is checked, and fails once.
 */
#define _GNU_SOURCE
#define _FILE_OFFSET_BITS 64
#include <fcntl.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/types.h>
#include <unistd.h>

static int kernel_open(const char* name, int flags);
static int kernel_close(int file);
static int kernel_ioctl(int file, unsigned long request, ...);
static void* kernel_mmap(void* at, size_t bytes, int protection, int flags, int file, off_t offset);
static int kernel_munmap(void* at, size_t bytes);
static int kernel_eventfd(unsigned value, int flags);
static ssize_t card_pread(int file, void* to, size_t bytes, off_t offset);
static ssize_t card_pwrite(int file, const void* from, size_t bytes, off_t offset);
#define open kernel_open
#define close kernel_close
#define ioctl kernel_ioctl
#define mmap kernel_mmap
#define munmap kernel_munmap
#define eventfd kernel_eventfd
#define pread card_pread
#define pwrite card_pwrite
#include "chip_linux.c"
#undef open
#undef close
#undef ioctl
#undef mmap
#undef munmap
#undef eventfd
#undef pread
#undef pwrite

#include <limits.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>
#include <sys/socket.h>

static int failures;
#define CHECK(condition) check(condition, #condition, __LINE__)
static void check(int good, const char* what, int line) {
  if (good) return;
  printf("%s:%d: %s\n", __FILE__, line, what);
  ++failures;
}

/* ---- a chip */

enum { MEMORY_BYTES = 65536, PAIRS = 2, MANY = 64, STEP_EVERY = 4 };
static const uint64_t ADDRESS = 0x100000000; /* of the memory, as the chip sees it */

struct beat {
  uint32_t offset, words[2]; /* offset MEMORY_BYTES: the record is counted */
};
static struct card {
  pthread_mutex_t mutex;
  volatile uint32_t* registers;
  volatile uint32_t* memory;
  struct beat beats[MANY];
  unsigned first, last; /* of the beats */
  uint32_t taken, written, calls;
  int event;     /* file of the interrupt, -1 none */
  int is_mapped; /* the driver writes the registers without a call */
  int armed;     /* UIO: the interrupt is not masked */
  int level;     /* of the line, as seen last */
  int files[3];  /* of the driver: registers, to the card, from the card */
  /* faults */
  int silent, refuse, gone, bits_of_bytes;
} card = {.mutex = PTHREAD_MUTEX_INITIALIZER};

#define REG(offset) card.registers[(offset) / 4]

/* In a mapped file: a status without it is one that the driver has written, to clear it. */
#define MARK 0x80000000

static void reset_card(void) {
  REG(CHIP_STATUS) = REG(CHIP_QUERY_PRODUCER) = REG(CHIP_QUERY_CONSUMER) = 0;
  REG(CHIP_RECORD_PRODUCER) = REG(CHIP_RECORD_CONSUMER) = 0;
  card.first = card.last = card.taken = card.written = 0;
}

static void write_record(uint32_t tag, uint32_t flags, uint32_t first, uint32_t second) {
  const uint32_t ring = (uint32_t)(((uint64_t)REG(CHIP_RECORD_BASE_HIGH) << 32 | REG(CHIP_RECORD_BASE_LOW)) - ADDRESS);
  const uint32_t log2 = REG(CHIP_RECORD_SIZE);
  const uint32_t at = ring + 16 * (card.written & ((1U << log2) - 1));
  const uint32_t phase = (card.written >> log2 & 1) == 0;
  ++card.written;
  card.beats[card.last++ % MANY] = (struct beat){at, {tag, flags | phase << 31}};
  card.beats[card.last++ % MANY] = (struct beat){at + 8, {first, second}};
  card.beats[card.last++ % MANY] = (struct beat){MEMORY_BYTES, {0, 0}};
}

/* One beat of a record, or the records of one query. */
static void step(void) {
  atomic_thread_fence(memory_order_seq_cst);
  if (REG(CHIP_CONTROL) == CHIP_CONTROL_SOFT_RESET) {
    REG(CHIP_CONTROL) = 0;
    reset_card();
  }
  if (card.is_mapped && REG(CHIP_INTERRUPT_STATUS) == CHIP_INTERRUPT_RECORD) {
    REG(CHIP_INTERRUPT_STATUS) = 0;
    card.level = 0; /* the line falls for a clock */
  }
  if (card.first != card.last) {
    const struct beat beat = card.beats[card.first++ % MANY];
    if (beat.offset != MEMORY_BYTES) {
      card.memory[beat.offset / 4] = beat.words[0];
      atomic_thread_fence(memory_order_seq_cst);
      card.memory[beat.offset / 4 + 1] = beat.words[1];
    } else {
      REG(CHIP_RECORD_PRODUCER) = REG(CHIP_RECORD_PRODUCER) + 1;
      REG(CHIP_INTERRUPT_STATUS) = REG(CHIP_INTERRUPT_STATUS) | CHIP_INTERRUPT_RECORD | (card.is_mapped ? MARK : 0);
    }
  } else if (!card.silent && REG(CHIP_CONTROL) == CHIP_CONTROL_ENABLE &&
             (uint16_t)REG(CHIP_QUERY_PRODUCER) != (uint16_t)card.taken) {
    const uint32_t tag = card.memory[16 * (card.taken % (1U << REG(CHIP_QUERY_SIZE)))];
    for (uint32_t i = 0; i < PAIRS; ++i) write_record(tag, 2, tag + 10 + i, tag + 20 + i);
    write_record(tag, 1 | 1 << 1, tag + 30, PAIRS);
    REG(CHIP_QUERY_CONSUMER) = ++card.taken;
  }
  atomic_thread_fence(memory_order_seq_cst);
  const int level = (REG(CHIP_INTERRUPT_STATUS) & REG(CHIP_INTERRUPT_ENABLE)) != 0;
  int32_t on;
  if (card.armed >= 0 && recv(card.event, &on, sizeof on, MSG_DONTWAIT) == sizeof on) card.armed = on;
  /* UIO: a level while it is armed. XDMA: an edge */
  if (card.event >= 0 && level && (card.armed > 0 || (card.armed < 0 && !card.level))) {
    const uint64_t count = 1;
    const size_t bytes = card.armed < 0 && card.is_mapped ? 8 : 4; /* of an eventfd; of the others */
    if (write(card.event, &count, bytes) != (ssize_t)bytes) abort();
    if (card.armed > 0) card.armed = 0;
  }
  card.level = level;
}

static ssize_t configuration(void* to, const void* from, size_t bytes, off_t offset);
static int is_vfio_device(int file);

static ssize_t card_pread(int file, void* to, size_t bytes, off_t offset) {
  if (is_vfio_device(file)) return configuration(to, NULL, bytes, offset);
  pthread_mutex_lock(&card.mutex);
  if (++card.calls % STEP_EVERY == 0) step();
  ssize_t n = -1;
  errno = EIO;
  if (!card.refuse) {
    if (card.bits_of_bytes && bytes > 4) bytes = 4; /* a file may do less than it is asked for */
    n = (ssize_t)bytes;
    if (card.gone) {
      memset(to, 0xFF, bytes);
    } else if (file == card.files[0] && bytes == 4 && offset % 4 == 0) {
      const uint32_t value = REG(offset);
      memcpy(to, &value, 4);
    } else if (file == card.files[2] && offset >= (off_t)ADDRESS && offset + n <= (off_t)ADDRESS + MEMORY_BYTES) {
      memcpy(to, (const char*)card.memory + (offset - (off_t)ADDRESS), bytes);
    } else {
      n = -1;
    }
  }
  pthread_mutex_unlock(&card.mutex);
  return n;
}

static ssize_t card_pwrite(int file, const void* from, size_t bytes, off_t offset) {
  if (is_vfio_device(file)) return configuration(NULL, from, bytes, offset);
  pthread_mutex_lock(&card.mutex);
  if (++card.calls % STEP_EVERY == 0) step();
  ssize_t n = -1;
  errno = EIO;
  if (!card.refuse) {
    if (card.bits_of_bytes && bytes > 4) bytes = 4;
    n = (ssize_t)bytes;
    if (file == card.files[0] && bytes == 4 && offset % 4 == 0) {
      uint32_t value;
      memcpy(&value, from, 4);
      if (offset == CHIP_INTERRUPT_STATUS) {
        REG(offset) = REG(offset) & ~value;
        card.level = 0; /* the line falls for a clock */
      } else {
        REG(offset) = value;
      }
      if (offset == CHIP_CONTROL && value == CHIP_CONTROL_SOFT_RESET) reset_card();
    } else if (file == card.files[1] && offset >= (off_t)ADDRESS && offset + n <= (off_t)ADDRESS + MEMORY_BYTES) {
      memcpy((char*)card.memory + (offset - (off_t)ADDRESS), from, bytes);
    } else {
      n = -1;
    }
  }
  pthread_mutex_unlock(&card.mutex);
  return n;
}

static atomic_int running;
static void* play(void* nothing) {
  const struct timespec pause = {0, 20000};
  while (running) {
    pthread_mutex_lock(&card.mutex);
    step();
    if (REG(CHIP_STATUS) == CHIP_STATUS_RESETTING && REG(CHIP_CONTROL) == 0) REG(CHIP_STATUS) = 0;
    pthread_mutex_unlock(&card.mutex);
    nanosleep(&pause, NULL);
  }
  return nothing;
}
static pthread_t start_thread(void) {
  pthread_t thread;
  running = 1;
  if (pthread_create(&thread, NULL, play, NULL) != 0) abort();
  return thread;
}
static void stop_thread(pthread_t thread) {
  running = 0;
  pthread_join(thread, NULL);
}

/* ---- queries */

enum { BY_POLLING, BY_INTERRUPT, BY_POINTERS };
static const uint32_t LONG = 60000000; /* us; never reached by a test that passes */

/* Asks so many queries, one by one. \returns those whose records are not the chip's; -1: a call has failed */
static int wrong_answers(struct chip* chip, int queries, int how) {
  int wrong = 0;
  for (int i = 0; i < queries; ++i) {
    const uint32_t tag = 100 * (uint32_t)(i + 1), query[16] = {tag};
    struct chip_record record = {0, 0, 0, 0};
    int right = 1;
    if (chip_submit(chip, query) != CHIP_OK) return -1;
    for (uint32_t k = 0; !chip_is_done(&record); ++k) {
      const int code = how == BY_INTERRUPT ? chip_wait(chip, &record, LONG) : chip_next(chip, &record);
      if (code != CHIP_OK) return -1;
      right = right && record.tag == tag;
      if (chip_is_done(&record)) {
        right = right && record.first == tag + 30 && record.second == PAIRS && k == PAIRS;
      } else {
        right = right && record.first == tag + 10 + k && record.second == tag + 20 + k;
      }
    }
    wrong += !right;
  }
  return wrong;
}

static char folder[] = "/tmp/cchip_linux_XXXXXX";
static const char* path(const char* name) {
  static char text[4][64];
  static unsigned next;
  char* to = text[next++ % 4];
  snprintf(to, sizeof text[0], "%s/%s", folder, name);
  return to;
}
static void make_file(const char* name, off_t bytes) {
  const int file = open(path(name), O_RDWR | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || ftruncate(file, bytes) != 0) abort();
  close(file);
}

static void identify(void) {
  REG(CHIP_ID) = CHIP_ID_VALUE;
  REG(CHIP_VERSION) = 2 << 8;
}

/* ---- XDMA */

static struct chip over_xdma(struct chip_linux* l) {
  static uint32_t registers[REGISTER_BYTES / 4], memory[MEMORY_BYTES / 4];
  memset(registers, 0, sizeof registers);
  memset(memory, 0, sizeof memory);
  card.registers = registers;
  card.memory = memory;
  card.silent = card.refuse = card.gone = card.bits_of_bytes = card.level = 0;
  card.armed = -1;
  card.is_mapped = 0;
  identify();
  reset_card();
  if (chip_open_xdma(l, path("xdma0"), ADDRESS, MEMORY_BYTES) != 0) abort();
  card.files[0] = l->registers;
  card.files[1] = l->to_card;
  card.files[2] = l->from_card;
  struct chip chip = {.address = ADDRESS, .port = &l->port, .limit_us = LONG, .confirm_records = 1};
  CHECK(chip_start(&chip) == CHIP_OK);
  return chip;
}

static void test_halves(void) {
  struct chip_linux l;
  struct chip chip = over_xdma(&l);
  CHECK(wrong_answers(&chip, 200, BY_POLLING) == 0);
  chip.confirm_records = 0; /* the memory does show halves */
  CHECK(chip_start(&chip) == CHIP_OK);
  CHECK(wrong_answers(&chip, 200, BY_POLLING) > 0);
  chip_close(&l);
}

static void test_interrupt(void) {
  struct chip_linux l;
  struct chip chip = over_xdma(&l);
  struct chip_record record;
  REG(CHIP_INTERRUPT_ENABLE) = CHIP_INTERRUPT_RECORD;
  pthread_t thread = start_thread();
  CHECK(l.events >= 0);
  CHECK(wrong_answers(&chip, 200, BY_INTERRUPT) == 0);
  card.silent = 1;
  const uint32_t query[16] = {7};
  CHECK(chip_submit(&chip, query) == CHIP_OK);
  const uint64_t before = now(NULL);
  CHECK(chip_wait(&chip, &record, 20000) == CHIP_TIMEOUT);
  CHECK(now(NULL) - before >= 20000);
  CHECK(chip.limit_us == LONG);
  REG(CHIP_STATUS) = CHIP_STATUS_QUERY_FAILED;
  CHECK(chip_wait(&chip, &record, 1000) == CHIP_STOPPED);
  stop_thread(thread);
  chip_close(&l);
}

static void test_faults(void) {
  struct chip_linux l;
  struct chip chip = over_xdma(&l);
  struct chip_record record;
  uint32_t words[2];
  const uint32_t query[16] = {7};
  chip.limit_us = 1000;
  CHECK(chip_next(&chip, &record) == CHIP_TIMEOUT);
  chip.limit_us = LONG;
  card.bits_of_bytes = 1;
  CHECK(wrong_answers(&chip, 50, BY_POLLING) == 0);
  REG(CHIP_STATUS) = CHIP_STATUS_RECORD_FAILED;
  CHECK(chip_next(&chip, &record) == CHIP_STOPPED);
  card.silent = 1;
  CHECK(chip_start(&chip) == CHIP_OK);
  for (int i = 0; i < 1 << CHIP_QUERY_LOG2; ++i) CHECK(chip_submit(&chip, query) == CHIP_OK);
  chip.limit_us = 1000;
  CHECK(chip_submit(&chip, query) == CHIP_TIMEOUT);
  card.refuse = 1;
  CHECK(chip_next(&chip, &record) == CHIP_LOST);
  CHECK(chip_submit(&chip, query) == CHIP_LOST);
  CHECK(chip_store(&chip, CHIP_IMAGES, query, 64) == CHIP_LOST);
  CHECK(chip_memory_limit(&chip, 1) == CHIP_LOST);
  CHECK(chip_start(&chip) == CHIP_NO_CHIP);
  card.refuse = card.silent = 0;
  chip.limit_us = LONG;
  CHECK(chip_start(&chip) == CHIP_OK);
  CHECK(wrong_answers(&chip, 5, BY_POLLING) == 0);
  card.gone = 1; /* reads are all ones */
  CHECK(chip_next(&chip, &record) == CHIP_LOST);
  CHECK(chip_start(&chip) == CHIP_NO_CHIP);
  card.gone = 0;
  CHECK(l.port.read(&l, MEMORY_BYTES - 4, words, 4) == CHIP_OK);
  CHECK(l.port.read(&l, MEMORY_BYTES - 4, words, 8) == CHIP_LOST);
  CHECK(l.port.write(&l, MEMORY_BYTES, words, 4) == CHIP_LOST);
  CHECK(l.port.write(&l, 2, words, 4) == CHIP_LOST);
  chip_close(&l);
}

/* ---- UIO */

static void test_mapped(void) {
  make_file("uio0", REGISTER_BYTES);
  make_file("memory", 4096 + MEMORY_BYTES);
  const int registers = open(path("uio0"), O_RDWR), memory = open(path("memory"), O_RDWR);
  card.registers = map(registers, REGISTER_BYTES, 0);
  card.memory = map(memory, MEMORY_BYTES, 4096);
  if (!card.registers || !card.memory) abort();
  card.silent = 0;
  card.is_mapped = 1;
  int both[2];
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, both) != 0) abort();
  card.event = both[0];
  identify();
  for (int how = BY_POLLING; how <= BY_POINTERS; ++how) {
    struct chip_linux l;
    CHECK(chip_open_uio(&l, path("uio0"), path("memory"), 4096, MEMORY_BYTES) == 0);
    CHECK(l.events < 0); /* the file is not UIO's */
    struct chip chip = {.address = ADDRESS, .port = &l.port, .limit_us = LONG, .confirm_records = 1};
    if (how == BY_POINTERS) {
      chip.port = NULL;
      chip.registers = card.registers;
      chip.memory = card.memory;
      chip.patience = ULONG_MAX;
    }
    reset_card();
    card.armed = 0;
    REG(CHIP_STATUS) = CHIP_STATUS_RESETTING; /* until the thread has seen the reset */
    REG(CHIP_INTERRUPT_STATUS) = 0;
    REG(CHIP_INTERRUPT_ENABLE) = CHIP_INTERRUPT_RECORD;
    pthread_t thread = start_thread();
    CHECK(chip_start(&chip) == CHIP_OK);
    if (how == BY_INTERRUPT) l.events = both[1];
    CHECK(wrong_answers(&chip, 100, how) == 0);
    stop_thread(thread);
    l.events = -1;
    chip_close(&l);
  }
  card.event = -1;
  close(both[0]);
  close(both[1]);
  close(registers);
  close(memory);
}

/* ---- VFIO: the calls of the kernel */

static const char GROUP[] = "/dev/vfio/26", DEVICE[] = "0000:01:00.0";
enum { BAR = 2, BAR_AT = 0x20000, CONFIGURATION_AT = 0x70000, MAPPABLE = 7 };

static const struct vfio {
  int container, group, device, event; /* files, -1: closed */
  void *memory, *registers;            /* mappings */
  int calls, fail_at;                  /* calls so far, and the one that fails */
  int version, type1, viable, is_pci;
  uint32_t bar_bytes, bar_flags, msi, msix;
  int master_sticks, empty; /* of the configuration space */
  uint8_t command[2];
  char log[1024];
} good = {.container = -1,
          .group = -1,
          .device = -1,
          .event = -1,
          .version = VFIO_API_VERSION,
          .type1 = 1,
          .viable = 1,
          .is_pci = 1,
          .bar_bytes = 65536,
          .bar_flags = MAPPABLE,
          .msi = 1,
          .msix = 8,
          .master_sticks = 1,
          .command = {0, 4}};
static struct vfio vfio = {.container = -1, .group = -1, .device = -1, .event = -1};

static void note(const char* what) {
  const size_t used = strlen(vfio.log);
  snprintf(vfio.log + used, sizeof vfio.log - used, "%s ", what);
}

/* A call of the driver. \returns whether it fails */
static int fails(const char* what) {
  note(what);
  errno = ENOSPC;
  return ++vfio.calls == vfio.fail_at;
}

static int is_vfio_device(int file) { return file >= 0 && file == vfio.device; }

static int any_file(void) {
  const int file = open("/dev/null", O_RDWR);
  if (file < 0) abort();
  return file;
}

static int kernel_open(const char* name, int flags) {
  if (strncmp(name, "/dev/vfio/", 10) != 0) return open(name, flags);
  CHECK(flags == (O_RDWR | O_CLOEXEC));
  if (fails(name)) return -1;
  int* const file = strcmp(name, GROUP) == 0 ? &vfio.group : &vfio.container;
  CHECK(*file < 0);
  return *file = any_file();
}

static int kernel_close(int file) {
  static const char* const names[] = {"-container", "-group", "-device", "-event"};
  int* const files[] = {&vfio.container, &vfio.group, &vfio.device, &vfio.event};
  for (unsigned i = 0; i < 4; ++i) {
    if (*files[i] != file) continue;
    *files[i] = -1;
    note(names[i]);
  }
  const int code = close(file);
  errno = EINTR; /* a call that succeeds may change it */
  return code;
}

static void* kernel_mmap(void* at, size_t bytes, int protection, int flags, int file, off_t offset) {
  const int anonymous = MAP_SHARED | MAP_ANONYMOUS, both = PROT_READ | PROT_WRITE;
  if (!is_vfio_device(file) && !(flags & MAP_ANONYMOUS)) return mmap(at, bytes, protection, flags, file, offset);
  const int is_bar = is_vfio_device(file);
  CHECK(protection == both && flags == (is_bar ? MAP_SHARED : anonymous));
  CHECK(bytes == (is_bar ? REGISTER_BYTES : MEMORY_BYTES) && offset == (is_bar ? BAR_AT : 0));
  if (fails(is_bar ? "bar" : "memory")) return MAP_FAILED;
  void* const made = mmap(NULL, bytes, both, anonymous, -1, 0);
  if (made == MAP_FAILED) abort();
  return *(is_bar ? &vfio.registers : &vfio.memory) = made;
}

static int kernel_munmap(void* at, size_t bytes) {
  if (at == vfio.registers) note("-bar");
  if (at == vfio.memory) note("-memory");
  CHECK(at != vfio.memory || bytes == MEMORY_BYTES);
  if (at == vfio.registers) vfio.registers = NULL;
  if (at == vfio.memory) vfio.memory = NULL;
  const int code = munmap(at, bytes);
  errno = EINTR;
  return code;
}

static int kernel_eventfd(unsigned value, int flags) {
  CHECK(value == 0 && flags == (EFD_CLOEXEC | EFD_NONBLOCK));
  return fails("eventfd") ? -1 : (vfio.event = eventfd(value, flags));
}

static ssize_t configuration(void* to, const void* from, size_t bytes, off_t offset) {
  CHECK(bytes == 2 && offset == CONFIGURATION_AT + 4);
  if (fails(to ? "read" : "write")) return -1;
  if (vfio.empty) return 0;
  if (to) memcpy(to, vfio.command, 2);
  if (from && vfio.master_sticks) memcpy(vfio.command, from, 2);
  return 2;
}

static int kernel_ioctl(int file, unsigned long request, ...) {
  va_list rest;
  va_start(rest, request);
  void* to = NULL;
  int number = 0;
  if (request == VFIO_CHECK_EXTENSION || request == VFIO_SET_IOMMU)
    number = va_arg(rest, int);
  else if (request != VFIO_GET_API_VERSION)
    to = va_arg(rest, void*);
  va_end(rest);
  const int owner =
      request == VFIO_GET_API_VERSION || request == VFIO_CHECK_EXTENSION || request == VFIO_SET_IOMMU ||
              request == VFIO_IOMMU_MAP_DMA
          ? vfio.container
      : request == VFIO_GROUP_GET_STATUS || request == VFIO_GROUP_SET_CONTAINER || request == VFIO_GROUP_GET_DEVICE_FD
          ? vfio.group
          : vfio.device;
  CHECK(file >= 0 && file == owner);
  char text[16];
  switch (request) {
    case VFIO_GET_API_VERSION:
      return fails("version") ? -1 : vfio.version;
    case VFIO_CHECK_EXTENSION:
      CHECK(number == VFIO_TYPE1v2_IOMMU);
      return fails("type1") ? -1 : vfio.type1;
    case VFIO_SET_IOMMU:
      CHECK(number == VFIO_TYPE1v2_IOMMU);
      return fails("iommu") ? -1 : 0;
    case VFIO_GROUP_GET_STATUS: {
      struct vfio_group_status* status = to;
      CHECK(status->argsz == sizeof *status);
      status->flags = vfio.viable ? VFIO_GROUP_FLAGS_VIABLE : 0;
      return fails("status") ? -1 : 0;
    }
    case VFIO_GROUP_SET_CONTAINER:
      CHECK(*(int*)to == vfio.container);
      return fails("container") ? -1 : 0;
    case VFIO_IOMMU_MAP_DMA: {
      const struct vfio_iommu_type1_dma_map* window = to;
      CHECK(window->argsz == sizeof *window && window->vaddr == (uintptr_t)vfio.memory);
      CHECK(window->iova == ADDRESS && window->size == MEMORY_BYTES);
      CHECK(window->flags == (VFIO_DMA_MAP_FLAG_READ | VFIO_DMA_MAP_FLAG_WRITE));
      return fails("dma") ? -1 : 0;
    }
    case VFIO_GROUP_GET_DEVICE_FD:
      CHECK(strcmp(to, DEVICE) == 0);
      return fails("device") ? -1 : (vfio.device = any_file());
    case VFIO_DEVICE_GET_INFO: {
      struct vfio_device_info* info = to;
      CHECK(info->argsz == sizeof *info);
      info->flags = vfio.is_pci ? VFIO_DEVICE_FLAGS_PCI : VFIO_DEVICE_FLAGS_PLATFORM;
      return fails("info") ? -1 : 0;
    }
    case VFIO_DEVICE_GET_REGION_INFO: {
      struct vfio_region_info* region = to;
      CHECK(region->argsz == sizeof *region);
      const int is_bar = region->index == BAR;
      CHECK(is_bar || region->index == VFIO_PCI_CONFIG_REGION_INDEX);
      region->offset = is_bar ? BAR_AT : CONFIGURATION_AT;
      region->size = is_bar ? vfio.bar_bytes : 4096;
      region->flags = is_bar ? vfio.bar_flags : 3;
      snprintf(text, sizeof text, "region%u", region->index);
      return fails(text) ? -1 : 0;
    }
    case VFIO_DEVICE_GET_IRQ_INFO: {
      struct vfio_irq_info* info = to;
      CHECK(info->argsz == sizeof *info);
      info->count = info->index == VFIO_PCI_MSI_IRQ_INDEX ? vfio.msi : vfio.msix;
      info->flags = VFIO_IRQ_INFO_EVENTFD;
      snprintf(text, sizeof text, "irq%u", info->index);
      return fails(text) ? -1 : 0;
    }
    case VFIO_DEVICE_SET_IRQS: {
      const struct vfio_irq_set* set = to;
      int32_t event;
      memcpy(&event, set->data, sizeof event);
      CHECK(set->argsz == sizeof *set + 4 && set->start == 0 && set->count == 1 && event == vfio.event);
      CHECK(set->index == (vfio.msi ? VFIO_PCI_MSI_IRQ_INDEX : VFIO_PCI_MSIX_IRQ_INDEX));
      CHECK(set->flags == (VFIO_IRQ_SET_DATA_EVENTFD | VFIO_IRQ_SET_ACTION_TRIGGER));
      return fails("set") ? -1 : 0;
    }
    default:
      CHECK(!"an ioctl that VFIO has not");
      return -1;
  }
}

static int open_vfio(struct chip_linux* l) { return chip_open_vfio(l, GROUP, DEVICE, BAR, ADDRESS, MEMORY_BYTES); }

static int is_shut(const struct chip_linux* l) {
  return vfio.container < 0 && vfio.group < 0 && vfio.device < 0 && vfio.event < 0 && !vfio.memory && !vfio.registers &&
         l->registers < 0 && l->events < 0 && l->container < 0 && l->group < 0 && !l->memory_words &&
         !l->register_words;
}

#define OPENED                                                                                                   \
  "/dev/vfio/vfio version type1 /dev/vfio/26 status container iommu memory dma device info region2 bar region7 " \
  "read write read "

static void test_vfio_calls(void) {
  struct chip_linux l;
  vfio = good;
  CHECK(open_vfio(&l) == 0);
  const int calls = vfio.calls;
  CHECK(calls == 20 && vfio.command[0] == 6 && vfio.command[1] == 4 && l.events >= 0);
  chip_close(&l);
  CHECK(strcmp(vfio.log, OPENED "irq1 eventfd set -bar -event -device -group -container -memory ") == 0);
  CHECK(is_shut(&l));
  for (int i = 1; i <= calls; ++i) { /* each call fails */
    vfio = good;
    vfio.fail_at = i;
    errno = 0;
    CHECK(open_vfio(&l) != 0 && errno == ENOSPC && strstr(l.error, strerror(ENOSPC)) && vfio.calls == i);
    CHECK(strstr(l.error, DEVICE) || strstr(l.error, GROUP) || strstr(l.error, "/dev/vfio/vfio") ||
          strstr(l.error, "the memory"));
    CHECK(is_shut(&l));
  }
}

static void test_vfio_answers(void) {
  struct chip_linux l;
  const struct {
    int* what;
    int value, why;
    const char* text;
  } faults[] = {
      {&vfio.version, 1, EPROTONOSUPPORT, "VFIO_GET_API_VERSION of /dev/vfio/vfio"},
      {&vfio.type1, 0, EOPNOTSUPP, "no IOMMU of type 1 behind /dev/vfio/vfio"},
      {&vfio.viable, 0, EBUSY, "a device of another driver in /dev/vfio/26"},
      {&vfio.is_pci, 0, ENODEV, "no such BAR of 0000:01:00.0"},
      {(int*)&vfio.bar_bytes, 2048, ENODEV, "no room for registers in the BAR of 0000:01:00.0"},
      {(int*)&vfio.bar_flags, 3, EOPNOTSUPP, "cannot map the BAR of 0000:01:00.0"},
      {&vfio.master_sticks, 0, EIO, "no bus master in 0000:01:00.0"},
      {&vfio.empty, 1, EIO, "read the command word of 0000:01:00.0"},
  };
  for (unsigned i = 0; i < sizeof faults / sizeof faults[0]; ++i) {
    vfio = good;
    *faults[i].what = faults[i].value;
    errno = 0;
    CHECK(open_vfio(&l) != 0 && errno == faults[i].why && is_shut(&l));
    char want[160];
    snprintf(want, sizeof want, "%s: %s", faults[i].text, strerror(faults[i].why));
    CHECK(strcmp(l.error, want) == 0);
  }
  vfio = good;
  CHECK(chip_open_vfio(&l, GROUP, DEVICE, 6, ADDRESS, MEMORY_BYTES) != 0 && errno == ENODEV && is_shut(&l));
  vfio = good;
  CHECK(chip_open_vfio(&l, GROUP, DEVICE, BAR, ADDRESS, CHIP_IMAGES - 4) != 0 && errno == EINVAL && vfio.calls == 0);
}

static void test_vfio_queries(void) {
  for (int kind = 0; kind < 3; ++kind) { /* MSI, MSI-X, neither */
    static const char* const ends[] = {OPENED "irq1 eventfd set ", OPENED "irq1 irq2 eventfd set ",
                                       OPENED "irq1 irq2 "};
    struct chip_linux l;
    struct chip_record record;
    const uint32_t query[16] = {7};
    vfio = good;
    if (kind > 0) vfio.msi = 0;
    if (kind > 1) vfio.msix = 0;
    CHECK(open_vfio(&l) == 0 && strcmp(vfio.log, ends[kind]) == 0);
    card.registers = vfio.registers;
    card.memory = vfio.memory;
    card.silent = card.level = 0;
    card.is_mapped = 1;
    card.armed = -1;
    card.event = l.events;
    CHECK((l.events >= 0) == (kind < 2));
    identify();
    reset_card();
    REG(CHIP_STATUS) = CHIP_STATUS_RESETTING;
    REG(CHIP_INTERRUPT_ENABLE) = CHIP_INTERRUPT_RECORD;
    pthread_t thread = start_thread();
    struct chip chip = {.address = ADDRESS, .port = &l.port, .limit_us = LONG, .confirm_records = 1};
    CHECK(chip_start(&chip) == CHIP_OK);
    CHECK(wrong_answers(&chip, 100, BY_INTERRUPT) == 0);
    CHECK(wrong_answers(&chip, 100, BY_POLLING) == 0);
    card.silent = 1;
    CHECK(chip_submit(&chip, query) == CHIP_OK);
    const uint64_t before = now(NULL);
    CHECK(chip_wait(&chip, &record, 20000) == CHIP_TIMEOUT && now(NULL) - before >= 20000);
    stop_thread(thread);
    chip_close(&l);
    CHECK(is_shut(&l));
  }
  card.event = -1;
}

static void test_opening(void) {
  struct chip_linux l;
  errno = 0;
  CHECK(chip_open_xdma(&l, path("none"), ADDRESS, MEMORY_BYTES) != 0 && errno == ENOENT);
  CHECK(chip_open_uio(&l, path("uio0"), path("none"), 0, MEMORY_BYTES) != 0 && errno == ENOENT);
  CHECK(l.register_words == NULL && l.registers == -1);
  CHECK(strstr(l.error, path("none")) && strstr(l.error, strerror(ENOENT)));
  CHECK(chip_open_xdma(&l, path("xdma0"), ADDRESS, CHIP_IMAGES - 4) != 0 && errno == EINVAL);
  CHECK(chip_clocks(60, 68) == 4080 && chip_clocks(0, 68) == 1 && chip_clocks(UINT32_MAX, 2) == UINT32_MAX);
}

int main(void) {
  if (!mkdtemp(folder)) abort();
  make_file("xdma0_user", 0);
  make_file("xdma0_h2c_0", 0);
  make_file("xdma0_c2h_0", 0);
  if (mkfifo(path("xdma0_events_0"), 0600) != 0) abort();
  card.event = open(path("xdma0_events_0"), O_RDWR); /* so that neither end waits for the other one */
  if (card.event < 0) abort();
  test_halves();
  test_interrupt();
  test_faults();
  close(card.event);
  test_mapped();
  test_opening();
  test_vfio_calls();
  test_vfio_answers();
  test_vfio_queries();
  const char* const names[] = {"xdma0_user", "xdma0_h2c_0", "xdma0_c2h_0", "xdma0_events_0", "uio0", "memory"};
  for (unsigned i = 0; i < sizeof names / sizeof names[0]; ++i) unlink(path(names[i]));
  rmdir(folder);
  if (failures == 0) printf("driver in C over files: all right\n");
  return failures != 0;
}
