// SPDX-License-Identifier: Apache-2.0
/*
 * A polling driver of cchip_chip in C11, without an operating system: registers and memory are two pointers, or calls of
 * a struct chip_port. It shows the order of events; docs/hardware/programmers-guide.md explains it. Images and queries
 * come from the host library (cchip/internal/bvh/image.hpp, cchip/internal/bvh/place.hpp).
 */
#include "chip_poll.h"

#include <stdatomic.h>
#include <string.h>

enum { RECORD_RING = 64 << CHIP_QUERY_LOG2, RECORD_BYTES = 16 << CHIP_RECORD_LOG2 }; /* in the memory */

static uint32_t get(struct chip* chip, unsigned offset) {
  const struct chip_port* port = chip->port;
  uint32_t value = 0xFFFFFFFF; /* as a bus without an answer */
  if (!port) return chip->registers[offset / 4];
  if (port->read32(port->context, offset, &value) != CHIP_OK) chip->lost = 1;
  return value;
}

/* Everything that was written to memory is there before a register says so. */
static void set(struct chip* chip, unsigned offset, uint32_t value) {
  const struct chip_port* port = chip->port;
  atomic_thread_fence(memory_order_seq_cst);
  if (!port) {
    chip->registers[offset / 4] = value;
  } else if (port->write32(port->context, offset, value) != CHIP_OK) {
    chip->lost = 1;
  }
}

/* Memory, whole words. */
static void put(struct chip* chip, uint32_t offset, const void* from, uint32_t bytes) {
  const struct chip_port* port = chip->port;
  if (port) {
    if (port->write(port->context, offset, from, bytes) != CHIP_OK) chip->lost = 1;
    return;
  }
  for (uint32_t i = 0; i < bytes / 4; ++i) {
    uint32_t word;
    memcpy(&word, (const char*)from + 4 * i, 4);
    chip->memory[offset / 4 + i] = word;
  }
}

static void fetch(struct chip* chip, uint32_t offset, uint32_t* to, uint32_t words) {
  const struct chip_port* port = chip->port;
  if (port) {
    if (port->read(port->context, offset, to, 4 * words) != CHIP_OK) chip->lost = 1;
    return;
  }
  for (uint32_t i = 0; i < words; ++i) to[i] = chip->memory[offset / 4 + i];
}

static uint64_t now(const struct chip* chip) { return chip->port ? chip->port->now(chip->port->context) : 0; }

/* Is the limit of a call over, which has looked `looks` times since `start`? */
static int is_over(const struct chip* chip, unsigned long looks, uint64_t start) {
  return chip->port ? now(chip) - start >= chip->limit_us : looks == chip->patience;
}

static int wait_for(struct chip* chip, uint32_t status) {
  const uint64_t start = now(chip);
  for (unsigned long i = 0; !chip->lost; ++i) {
    if ((get(chip, CHIP_STATUS) & status) == 0) return CHIP_OK;
    if (is_over(chip, i, start)) return CHIP_TIMEOUT;
  }
  return CHIP_LOST;
}

/* Resets the chip, makes both rings empty, enables it. Also the way back after CHIP_STOPPED. */
int chip_start(struct chip* chip) {
  static const uint32_t zeros[16];
  const uint64_t records = chip->address + RECORD_RING;
  chip->lost = 0;
  if (get(chip, CHIP_ID) != CHIP_ID_VALUE || get(chip, CHIP_VERSION) >> 8 != 2) return CHIP_NO_CHIP;
  set(chip, CHIP_CONTROL, CHIP_CONTROL_SOFT_RESET);
  const int code = wait_for(chip, CHIP_STATUS_RESETTING);
  if (code != CHIP_OK) return code; /* CHIP_TIMEOUT: memory has lost a response */
  chip->written = chip->read = chip->confirmed = 0;
  for (uint32_t i = 0; i < RECORD_BYTES; i += sizeof zeros) /* phase bits: no record is there */
    put(chip, RECORD_RING + i, zeros, sizeof zeros);
  set(chip, CHIP_QUERY_BASE_LOW, (uint32_t)chip->address);
  set(chip, CHIP_QUERY_BASE_HIGH, (uint32_t)(chip->address >> 32));
  set(chip, CHIP_QUERY_SIZE, CHIP_QUERY_LOG2);
  set(chip, CHIP_RECORD_BASE_LOW, (uint32_t)records);
  set(chip, CHIP_RECORD_BASE_HIGH, (uint32_t)(records >> 32));
  set(chip, CHIP_RECORD_SIZE, CHIP_RECORD_LOG2);
  set(chip, CHIP_CONTROL, CHIP_CONTROL_ENABLE);
  return chip->lost ? CHIP_LOST : CHIP_OK;
}

/* Longest wait of the chip for memory, which a soft reset keeps. */
int chip_memory_limit(struct chip* chip, uint32_t clocks) {
  set(chip, CHIP_MEMORY_LIMIT, clocks);
  return chip->lost ? CHIP_LOST : CHIP_OK;
}

/* Writes an image `offset` bytes into the memory; no query in flight uses these lines. The chip drops its copies of
 * them. */
int chip_store(struct chip* chip, uint32_t offset, const void* image, uint32_t bytes) {
  const uint32_t line = (uint32_t)((chip->address + offset) / 64);
  put(chip, offset, image, bytes);
  set(chip, CHIP_INVALIDATE_FIRST, line);
  set(chip, CHIP_INVALIDATE_LAST, line + bytes / 64 - 1);
  set(chip, CHIP_INVALIDATE, 1);
  return wait_for(chip, CHIP_STATUS_INVALIDATING);
}

/* Hands over a query of 64 bytes; waits for room in the ring. */
int chip_submit(struct chip* chip, const void* query) {
  const uint32_t place = chip->written & ((1U << CHIP_QUERY_LOG2) - 1);
  const uint64_t start = now(chip);
  for (unsigned long i = 0; (uint16_t)(chip->written - get(chip, CHIP_QUERY_CONSUMER)) >> CHIP_QUERY_LOG2 != 0; ++i) {
    if (chip->lost) return CHIP_LOST;
    if (is_over(chip, i, start)) return CHIP_TIMEOUT;
  }
  put(chip, 64 * place, query, 64);
  ++chip->written;
  set(chip, CHIP_QUERY_PRODUCER, chip->written & 0xFFFF); /* the doorbell */
  return chip->lost ? CHIP_LOST : CHIP_OK;
}

/* Is the next record there? Its phase bit may be there before the rest, if its two halves are written one by one; the
 * register counts a record when memory has confirmed both. */
static int is_there(struct chip* chip, uint32_t at) {
  const uint32_t phase = (chip->read >> CHIP_RECORD_LOG2 & 1) == 0; /* 1 in the first round of the ring */
  uint32_t word = ~phase << 31;
  fetch(chip, at + 4, &word, 1);
  if (word >> 31 != phase) return 0;
  if (chip->confirm_records && chip->confirmed == chip->read) chip->confirmed = get(chip, CHIP_RECORD_PRODUCER);
  return !chip->lost && (!chip->confirm_records || chip->confirmed != chip->read);
}

/* Waits for the next record. Pair records of a query come before its done record; queries end in any order. */
int chip_next(struct chip* chip, struct chip_record* record) {
  const uint32_t place = chip->read & ((1U << CHIP_RECORD_LOG2) - 1);
  const uint32_t at = RECORD_RING + 16 * place;
  const uint64_t start = now(chip);
  uint32_t words[4] = {0, 0, 0, 0};
  for (unsigned long i = 0; !is_there(chip, at); ++i) {
    const uint32_t failed = CHIP_STATUS_QUERY_FAILED | CHIP_STATUS_RECORD_FAILED;
    if (i % 1024 == 1023 && (get(chip, CHIP_STATUS) & failed) != 0) return chip->lost ? CHIP_LOST : CHIP_STOPPED;
    if (chip->lost) return CHIP_LOST;
    if (is_over(chip, i, start)) return CHIP_TIMEOUT;
  }
  atomic_thread_fence(memory_order_acquire); /* the rest of the record is not read before its phase */
  fetch(chip, at, words, 4);
  if (words[1] == 0xFFFFFFFF) chip->lost = 1; /* no record has these flags, a card that has left the bus has */
  if (chip->lost) return CHIP_LOST;
  record->tag = words[0];
  record->flags = words[1] & 0x7FFFFFFF;
  record->first = words[2];
  record->second = words[3];
  ++chip->read;
  set(chip, CHIP_RECORD_CONSUMER, chip->read); /* room for the next one; a host may do this less often */
  return CHIP_OK;
}

/* Of an interrupt's handler, for a controller of levels and of edges alike: clears the event "one more record" and says
 * whether it was there. Read all records each time it was, until it is not. */
int chip_event(struct chip* chip) {
  if ((get(chip, CHIP_INTERRUPT_STATUS) & CHIP_INTERRUPT_RECORD) == 0 || chip->lost) return 0;
  set(chip, CHIP_INTERRUPT_STATUS, CHIP_INTERRUPT_RECORD);
  return 1;
}

/* chip_next() that sleeps until an interrupt, for at most so long. Over a port; the interrupt of records is enabled. */
int chip_wait(struct chip* chip, struct chip_record* record, uint32_t microseconds) {
  const uint64_t start = now(chip), limit_us = chip->limit_us;
  for (;;) {
    chip->limit_us = 0; /* one look */
    int code = chip_next(chip, record);
    chip->limit_us = limit_us;
    if (code != CHIP_TIMEOUT) return code;
    const uint64_t passed = now(chip) - start;
    if (passed >= microseconds) {
      const uint32_t failed = CHIP_STATUS_QUERY_FAILED | CHIP_STATUS_RECORD_FAILED;
      const int stopped = (get(chip, CHIP_STATUS) & failed) != 0;
      return chip->lost ? CHIP_LOST : stopped ? CHIP_STOPPED : CHIP_TIMEOUT;
    }
    code = chip->port->wait(chip->port->context, (uint32_t)(microseconds - passed));
    if (code == CHIP_LOST) {
      chip->lost = 1;
      return CHIP_LOST;
    }
    chip_event(chip); /* before the next look: an event after it is an interrupt again */
  }
}
