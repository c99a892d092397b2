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
#include <linux/vfio.h>
#include <poll.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
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

/* A file that ends early is an error without errno: EIO. */
static int read_all(int file, void* to, size_t bytes, uint64_t offset) {
  for (size_t done = 0; done < bytes;) {
    const ssize_t n = pread(file, (char*)to + done, bytes - done, (off_t)(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = EIO;
    if (n <= 0) return CHIP_LOST;
    done += (size_t)n;
  }
  return CHIP_OK;
}

static int write_all(int file, const void* from, size_t bytes, uint64_t offset) {
  for (size_t done = 0; done < bytes;) {
    const ssize_t n = pwrite(file, (const char*)from + done, bytes - done, (off_t)(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = EIO;
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

/* UIO masks an interrupt that it reports; XDMA and eventfd count. Each file is readable once one has come. Without a
 * file this sleeps a while, so that the caller polls. */
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
    uint64_t count;
    const ssize_t n = read(l->events, &count, l->event_bytes);
    if (n == (ssize_t)l->event_bytes) return CHIP_OK;
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    return CHIP_LOST;
  }
}

/* ---- opening */

static volatile uint32_t* map(int file, uint32_t bytes, uint64_t offset) {
  void* at = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, (off_t)offset);
  return at == MAP_FAILED ? NULL : at;
}

/* What failed, in words; nothing is open afterwards. */
static int fail(struct chip_linux* l, const char* what, const char* name) {
  const int why = errno;
  snprintf(l->error, sizeof l->error, "%s %s: %s", what, name, strerror(why));
  chip_close(l);
  errno = why;
  return 1;
}

static int refuse(struct chip_linux* l, const char* what, const char* name, int why) {
  errno = why;
  return fail(l, what, name);
}

static int begin(struct chip_linux* l, uint32_t bytes) {
  memset(l, 0, sizeof *l);
  l->registers = l->events = l->to_card = l->from_card = l->container = l->group = -1;
  l->bytes = bytes;
  l->event_bytes = 4;
  l->port.context = l;
  l->port.wait = wait_event;
  l->port.now = now;
  return bytes % 4 == 0 && bytes >= CHIP_IMAGES ? 0 : refuse(l, "size of", "the memory", EINVAL);
}

static void access_mappings(struct chip_linux* l) {
  l->port.read32 = mapped_read32;
  l->port.write32 = mapped_write32;
  l->port.read = mapped_read;
  l->port.write = mapped_write;
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
  access_mappings(l);
  l->arms = 1;
  l->registers = open(registers, O_RDWR | O_CLOEXEC | O_SYNC);
  if (l->registers < 0) return fail(l, "open", registers);
  l->register_words = map(l->registers, REGISTER_BYTES, 0);
  if (!l->register_words) return fail(l, "map", registers);
  if (is_uio(l->registers)) l->events = l->registers;
  const int file = open(memory, O_RDWR | O_CLOEXEC | O_SYNC); /* u-dma-buf, /dev/mem: an uncached mapping on Arm */
  if (file < 0) return fail(l, "open", memory);
  l->memory_words = map(file, bytes, offset);
  const int why = errno;
  close(file);
  return l->memory_words ? 0 : refuse(l, "map", memory, why);
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
  if (l->registers < 0) return fail(l, "open _user of", name);
  l->to_card = open_one(name, "_h2c_0", O_WRONLY);
  if (l->to_card < 0) return fail(l, "open _h2c_0 of", name);
  l->from_card = open_one(name, "_c2h_0", O_RDONLY);
  if (l->from_card < 0) return fail(l, "open _c2h_0 of", name);
  l->events = open_one(name, "_events_0", O_RDONLY);
  return l->events < 0 && errno != ENOENT ? fail(l, "open _events_0 of", name) : 0;
}

/* ---- VFIO: Documentation/driver-api/vfio.rst of Linux */

static int vfio_container(struct chip_linux* l, const char* group) {
  static const char all[] = "/dev/vfio/vfio";
  l->container = open(all, O_RDWR | O_CLOEXEC);
  if (l->container < 0) return fail(l, "open", all);
  const int version = ioctl(l->container, VFIO_GET_API_VERSION);
  if (version < 0) return fail(l, "VFIO_GET_API_VERSION of", all);
  if (version != VFIO_API_VERSION) return refuse(l, "VFIO_GET_API_VERSION of", all, EPROTONOSUPPORT);
  const int found = ioctl(l->container, VFIO_CHECK_EXTENSION, VFIO_TYPE1v2_IOMMU);
  if (found < 0) return fail(l, "VFIO_CHECK_EXTENSION of", all);
  if (!found) return refuse(l, "no IOMMU of type 1 behind", all, EOPNOTSUPP);
  l->group = open(group, O_RDWR | O_CLOEXEC);
  if (l->group < 0) return fail(l, "open", group);
  struct vfio_group_status status = {.argsz = sizeof status};
  if (ioctl(l->group, VFIO_GROUP_GET_STATUS, &status) < 0) return fail(l, "VFIO_GROUP_GET_STATUS of", group);
  if (!(status.flags & VFIO_GROUP_FLAGS_VIABLE)) return refuse(l, "a device of another driver in", group, EBUSY);
  if (ioctl(l->group, VFIO_GROUP_SET_CONTAINER, &l->container) < 0) {
    return fail(l, "VFIO_GROUP_SET_CONTAINER of", group);
  }
  return ioctl(l->container, VFIO_SET_IOMMU, VFIO_TYPE1v2_IOMMU) < 0 ? fail(l, "VFIO_SET_IOMMU of", group) : 0;
}

/* The kernel keeps the pages where they are until the container is closed. */
static int vfio_memory(struct chip_linux* l, uint64_t address) {
  void* at = mmap(NULL, l->bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (at == MAP_FAILED) return fail(l, "allocate", "the memory");
  l->memory_words = at;
  struct vfio_iommu_type1_dma_map window = {.argsz = sizeof window,
                                            .flags = VFIO_DMA_MAP_FLAG_READ | VFIO_DMA_MAP_FLAG_WRITE,
                                            .vaddr = (uintptr_t)at,
                                            .iova = address,
                                            .size = l->bytes};
  return ioctl(l->container, VFIO_IOMMU_MAP_DMA, &window) < 0 ? fail(l, "VFIO_IOMMU_MAP_DMA of", "the memory") : 0;
}

static int vfio_region(struct chip_linux* l, uint32_t index, struct vfio_region_info* region) {
  *region = (struct vfio_region_info){.argsz = sizeof *region, .index = index};
  return ioctl(l->registers, VFIO_DEVICE_GET_REGION_INFO, region) < 0;
}

static int vfio_device(struct chip_linux* l, const char* device, uint32_t bar) {
  enum { COMMAND = 4, MEMORY_AND_MASTER = 6 }; /* of the PCI configuration space */
  l->registers = ioctl(l->group, VFIO_GROUP_GET_DEVICE_FD, device);
  if (l->registers < 0) return fail(l, "VFIO_GROUP_GET_DEVICE_FD of", device);
  struct vfio_device_info info = {.argsz = sizeof info};
  if (ioctl(l->registers, VFIO_DEVICE_GET_INFO, &info) < 0) return fail(l, "VFIO_DEVICE_GET_INFO of", device);
  if (!(info.flags & VFIO_DEVICE_FLAGS_PCI) || bar > VFIO_PCI_BAR5_REGION_INDEX) {
    return refuse(l, "no such BAR of", device, ENODEV);
  }
  struct vfio_region_info region;
  if (vfio_region(l, bar, &region)) return fail(l, "VFIO_DEVICE_GET_REGION_INFO of", device);
  const uint32_t needed = VFIO_REGION_INFO_FLAG_READ | VFIO_REGION_INFO_FLAG_WRITE | VFIO_REGION_INFO_FLAG_MMAP;
  if (region.size < REGISTER_BYTES) return refuse(l, "no room for registers in the BAR of", device, ENODEV);
  if ((region.flags & needed) != needed) return refuse(l, "cannot map the BAR of", device, EOPNOTSUPP);
  l->register_words = map(l->registers, REGISTER_BYTES, region.offset);
  if (!l->register_words) return fail(l, "map the BAR of", device);
  /* vfio-pci leaves the bus master off, and without it no access of the chip reaches memory */
  if (vfio_region(l, VFIO_PCI_CONFIG_REGION_INDEX, &region)) return fail(l, "configuration space of", device);
  uint8_t command[2];
  if (read_all(l->registers, command, 2, region.offset + COMMAND)) return fail(l, "read the command word of", device);
  command[0] |= MEMORY_AND_MASTER;
  if (write_all(l->registers, command, 2, region.offset + COMMAND) ||
      read_all(l->registers, command, 2, region.offset + COMMAND)) {
    return fail(l, "write the command word of", device);
  }
  if ((command[0] & MEMORY_AND_MASTER) != MEMORY_AND_MASTER) return refuse(l, "no bus master in", device, EIO);
  return 0;
}

/* An eventfd for the first MSI, or MSI-X where there is none. INTx would need to be unmasked after each. */
static int vfio_interrupt(struct chip_linux* l, const char* device) {
  static const uint32_t kinds[] = {VFIO_PCI_MSI_IRQ_INDEX, VFIO_PCI_MSIX_IRQ_INDEX};
  for (unsigned i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
    struct vfio_irq_info info = {.argsz = sizeof info, .index = kinds[i]};
    if (ioctl(l->registers, VFIO_DEVICE_GET_IRQ_INFO, &info) < 0) return fail(l, "VFIO_DEVICE_GET_IRQ_INFO of", device);
    if (info.count == 0 || !(info.flags & VFIO_IRQ_INFO_EVENTFD)) continue;
    l->event_bytes = 8;
    l->events = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (l->events < 0) return fail(l, "eventfd for", device);
    const int32_t file = l->events;
    union {
      struct vfio_irq_set set;
      char bytes[sizeof(struct vfio_irq_set) + sizeof file];
    } request = {.set = {.argsz = sizeof request,
                         .flags = VFIO_IRQ_SET_DATA_EVENTFD | VFIO_IRQ_SET_ACTION_TRIGGER,
                         .index = kinds[i],
                         .start = 0,
                         .count = 1}};
    memcpy(request.bytes + sizeof(struct vfio_irq_set), &file, sizeof file);
    return ioctl(l->registers, VFIO_DEVICE_SET_IRQS, &request) < 0 ? fail(l, "VFIO_DEVICE_SET_IRQS of", device) : 0;
  }
  return 0;
}

int chip_open_vfio(struct chip_linux* l, const char* group, const char* device, uint32_t bar, uint64_t address,
                   uint32_t bytes) {
  if (begin(l, bytes)) return 1;
  access_mappings(l);
  return vfio_container(l, group) || vfio_memory(l, address) || vfio_device(l, device, bar) ||
         vfio_interrupt(l, device);
}

/* The device of VFIO is closed, and so has stopped, before its memory goes. */
void chip_close(struct chip_linux* l) {
  if (l->register_words) munmap((void*)l->register_words, REGISTER_BYTES);
  if (l->events >= 0 && l->events != l->registers) close(l->events);
  if (l->registers >= 0) close(l->registers);
  if (l->group >= 0) close(l->group);
  if (l->container >= 0) close(l->container);
  if (l->memory_words) munmap((void*)l->memory_words, l->bytes);
  if (l->to_card >= 0) close(l->to_card);
  if (l->from_card >= 0) close(l->from_card);
  l->registers = l->events = l->to_card = l->from_card = l->container = l->group = -1;
  l->register_words = l->memory_words = NULL;
}
