// SPDX-License-Identifier: Apache-2.0
/* A polling driver of cchip_chip in C: see docs/hardware/programmers-guide.md. */
#ifndef CHIP_POLL_H
#define CHIP_POLL_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Byte offsets of the registers that this driver uses (docs/hardware/chip-registers.md). */
enum {
  CHIP_ID = 0x000,
  CHIP_VERSION = 0x004,
  CHIP_CAPABILITIES = 0x008,
  CHIP_CONTROL = 0x010,
  CHIP_STATUS = 0x014,
  CHIP_INTERRUPT_STATUS = 0x020,
  CHIP_INTERRUPT_ENABLE = 0x024,
  CHIP_MEMORY_LIMIT = 0x034,
  CHIP_QUERY_BASE_LOW = 0x040,
  CHIP_QUERY_BASE_HIGH = 0x044,
  CHIP_QUERY_SIZE = 0x048,
  CHIP_QUERY_PRODUCER = 0x04C,
  CHIP_QUERY_CONSUMER = 0x050,
  CHIP_RECORD_BASE_LOW = 0x060,
  CHIP_RECORD_BASE_HIGH = 0x064,
  CHIP_RECORD_SIZE = 0x068,
  CHIP_RECORD_CONSUMER = 0x06C,
  CHIP_RECORD_PRODUCER = 0x070,
  CHIP_INVALIDATE_FIRST = 0x0A0,
  CHIP_INVALIDATE_LAST = 0x0A4,
  CHIP_INVALIDATE = 0x0A8
};

enum {
  CHIP_ID_VALUE = 0x43484343,
  CHIP_CONTROL_ENABLE = 1,
  CHIP_CONTROL_SOFT_RESET = 2,
  CHIP_INTERRUPT_RECORD = 1,
  CHIP_STATUS_RESETTING = 1,
  CHIP_STATUS_QUERY_FAILED = 4,
  CHIP_STATUS_RECORD_FAILED = 8,
  CHIP_STATUS_INVALIDATING = 16
};

/* What a call returns. */
enum { CHIP_OK = 0, CHIP_NO_CHIP, CHIP_TIMEOUT, CHIP_STOPPED, CHIP_LOST /* the port has refused a call */ };

/* Both rings at the beginning of the memory that host and chip share, images behind them. */
enum { CHIP_QUERY_LOG2 = 4, CHIP_RECORD_LOG2 = 6 };
enum { CHIP_IMAGES = (64 << CHIP_QUERY_LOG2) + (16 << CHIP_RECORD_LOG2) };

/* Registers, memory and interrupt behind calls, for a host that maps them otherwise or not at all. Each call returns
 * CHIP_OK or CHIP_LOST, `wait` also CHIP_TIMEOUT. Offsets are multiples of 4, those of memory count from its beginning. */
struct chip_port {
  void *context; /* of every call */
  int (*read32)(void *context, uint32_t offset, uint32_t *value);
  int (*write32)(void *context, uint32_t offset, uint32_t value);
  int (*read)(void *context, uint32_t offset, void *to, uint32_t bytes);
  int (*write)(void *context, uint32_t offset, const void *from, uint32_t bytes);
  int (*wait)(void *context, uint32_t microseconds); /* for an interrupt */
  uint64_t (*now)(void *context);                    /* microseconds since any time */
};

struct chip {
  volatile uint32_t *registers;
  volatile uint32_t *memory;  /* as the host sees it */
  uint64_t address;           /* of the same memory as the chip sees it, a multiple of 64 */
  uint32_t written, read;     /* queries, records */
  unsigned long patience;     /* looks at a register or a record before a call gives up */
  /* 1: memory may show half a record, as behind a port of 64 bits; accept it when record_producer counts it */
  int confirm_records;
  uint32_t confirmed;         /* records that it counts */
  const struct chip_port *port; /* instead of the two pointers */
  uint64_t limit_us;          /* over a port, instead of patience: microseconds before a call gives up */
  int lost;                   /* the port has refused a call; chip_start() begins anew */
};

/* 16 bytes: pair or done. */
struct chip_record {
  uint32_t tag, flags, first, second;
};
static inline int chip_is_done(const struct chip_record *r) { return (int)(r->flags & 1); }
/* of a pair: 1 they touch, 0 the host has to decide; faces are `first` and `second` */
static inline int chip_is_definite(const struct chip_record *r) { return (int)(r->flags >> 1 & 1); }
/* of done: 0 no, 1 yes, 2 open; node pairs are `first`, pair records `second` */
static inline unsigned chip_answer(const struct chip_record *r) { return r->flags >> 1 & 3; }
/* of done: 0 ok, 1 for the host, others: errors, the host answers the query itself */
static inline unsigned chip_code(const struct chip_record *r) { return r->flags >> 8 & 0xFF; }

int chip_start(struct chip *chip);
int chip_store(struct chip *chip, uint32_t offset, const void *image, uint32_t bytes);
int chip_submit(struct chip *chip, const void *query);
int chip_next(struct chip *chip, struct chip_record *record);
int chip_event(struct chip *chip);
int chip_wait(struct chip *chip, struct chip_record *record, uint32_t microseconds);
int chip_memory_limit(struct chip *chip, uint32_t clocks);
/* A limit in clocks of the chip, from microseconds; never 0, which means the default. */
static inline uint32_t chip_clocks(uint32_t microseconds, uint32_t clock_mhz) {
  const uint64_t clocks = (uint64_t)microseconds * clock_mhz;
  return clocks > UINT32_MAX ? UINT32_MAX : clocks == 0 ? 1 : (uint32_t)clocks;
}

#ifdef __cplusplus
}
#endif

#endif
