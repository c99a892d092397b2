// SPDX-License-Identifier: Apache-2.0
/*
 * A polling driver of cchip_chip in C11, without an operating system: registers and memory are two pointers. It shows
 * the order of events; docs/hardware/programmers-guide.md explains it. Images and queries come from the host library
 * (cchip/internal/bvh/image.hpp, cchip/internal/bvh/place.hpp).
 */
#include "chip_poll.h"

#include <stdatomic.h>
#include <string.h>

static uint32_t get(const struct chip* chip, unsigned offset) { return chip->registers[offset / 4]; }

/* Everything that was written to memory is there before a register says so. */
static void set(struct chip* chip, unsigned offset, uint32_t value) {
  atomic_thread_fence(memory_order_seq_cst);
  chip->registers[offset / 4] = value;
}

static void copy(volatile uint32_t* to, const void* from, uint32_t bytes) {
  for (uint32_t i = 0; i < bytes / 4; ++i) {
    uint32_t word;
    memcpy(&word, (const char*)from + 4 * i, 4);
    to[i] = word;
  }
}

static int wait_for(struct chip* chip, uint32_t status) {
  for (unsigned long i = 0; i < chip->patience; ++i) {
    if ((get(chip, CHIP_STATUS) & status) == 0) return CHIP_OK;
  }
  return CHIP_TIMEOUT;
}

/* Resets the chip, makes both rings empty, enables it. Also the way back after CHIP_STOPPED. */
int chip_start(struct chip* chip) {
  const uint64_t records = chip->address + (64 << CHIP_QUERY_LOG2);
  if (get(chip, CHIP_ID) != CHIP_ID_VALUE || get(chip, CHIP_VERSION) >> 8 != 2) return CHIP_NO_CHIP;
  set(chip, CHIP_CONTROL, CHIP_CONTROL_SOFT_RESET);
  if (wait_for(chip, CHIP_STATUS_RESETTING) != CHIP_OK) return CHIP_TIMEOUT; /* memory has lost a response */
  chip->written = chip->read = 0;
  for (uint32_t i = 0; i < (16U << CHIP_RECORD_LOG2) / 4; ++i) /* phase bits: no record is there */
    chip->memory[(64U << CHIP_QUERY_LOG2) / 4 + i] = 0;
  set(chip, CHIP_QUERY_BASE_LOW, (uint32_t)chip->address);
  set(chip, CHIP_QUERY_BASE_HIGH, (uint32_t)(chip->address >> 32));
  set(chip, CHIP_QUERY_SIZE, CHIP_QUERY_LOG2);
  set(chip, CHIP_RECORD_BASE_LOW, (uint32_t)records);
  set(chip, CHIP_RECORD_BASE_HIGH, (uint32_t)(records >> 32));
  set(chip, CHIP_RECORD_SIZE, CHIP_RECORD_LOG2);
  set(chip, CHIP_CONTROL, CHIP_CONTROL_ENABLE);
  return CHIP_OK;
}

/* Writes an image `offset` bytes into the memory; no query in flight uses these lines. The chip drops its copies of
 * them. */
int chip_store(struct chip* chip, uint32_t offset, const void* image, uint32_t bytes) {
  const uint32_t line = (uint32_t)((chip->address + offset) / 64);
  copy(chip->memory + offset / 4, image, bytes);
  set(chip, CHIP_INVALIDATE_FIRST, line);
  set(chip, CHIP_INVALIDATE_LAST, line + bytes / 64 - 1);
  set(chip, CHIP_INVALIDATE, 1);
  return wait_for(chip, CHIP_STATUS_INVALIDATING);
}

/* Hands over a query of 64 bytes; waits for room in the ring. */
int chip_submit(struct chip* chip, const void* query) {
  const uint32_t place = chip->written & ((1U << CHIP_QUERY_LOG2) - 1);
  for (unsigned long i = 0; (uint16_t)(chip->written - get(chip, CHIP_QUERY_CONSUMER)) >> CHIP_QUERY_LOG2 != 0; ++i) {
    if (i == chip->patience) return CHIP_TIMEOUT;
  }
  copy(chip->memory + 16 * place, query, 64);
  ++chip->written;
  set(chip, CHIP_QUERY_PRODUCER, chip->written & 0xFFFF); /* the doorbell */
  return CHIP_OK;
}

/* Waits for the next record. Pair records of a query come before its done record; queries end in any order. */
int chip_next(struct chip* chip, struct chip_record* record) {
  const uint32_t place = chip->read & ((1U << CHIP_RECORD_LOG2) - 1);
  volatile uint32_t* at = chip->memory + (64U << CHIP_QUERY_LOG2) / 4 + 4 * place;
  const uint32_t phase = (chip->read >> CHIP_RECORD_LOG2 & 1) == 0; /* 1 in the first round of the ring */
  for (unsigned long i = 0; at[1] >> 31 != phase; ++i) {
    const uint32_t failed = CHIP_STATUS_QUERY_FAILED | CHIP_STATUS_RECORD_FAILED;
    if (i % 1024 == 1023 && (get(chip, CHIP_STATUS) & failed) != 0) return CHIP_STOPPED;
    if (i == chip->patience) return CHIP_TIMEOUT;
  }
  atomic_thread_fence(memory_order_acquire); /* the rest of the record is not read before its phase */
  record->tag = at[0];
  record->flags = at[1] & 0x7FFFFFFF;
  record->first = at[2];
  record->second = at[3];
  ++chip->read;
  set(chip, CHIP_RECORD_CONSUMER, chip->read); /* room for the next one; a host may do this less often */
  return CHIP_OK;
}

/* Of an interrupt's handler, for a controller of levels and of edges alike: clears the event "one more record" and says
 * whether it was there. Read all records each time it was, until it is not. */
int chip_event(struct chip* chip) {
  if ((get(chip, CHIP_INTERRUPT_STATUS) & CHIP_INTERRUPT_RECORD) == 0) return 0;
  set(chip, CHIP_INTERRUPT_STATUS, CHIP_INTERRUPT_RECORD);
  return 1;
}
