// SPDX-License-Identifier: Apache-2.0
/*
 * A program without an operating system for scripts/litex/query_soc.py: asks the chip a query with the driver of the
 * programmer's guide and prints the answer. query.h is written by query_soc.py, which also puts the images into memory:
 * at the first use of an address the chip needs no invalidation, otherwise chip_store() brings them.
 */
#include <stddef.h>
#include <stdint.h>

#include "chip_poll.h"
#include "query.h"

static void print_character(char c) { *(volatile uint32_t*)CONSOLE = (uint8_t)c; }

static void print(const char* text) {
  while (*text) print_character(*text++);
}

static void print_byte(uint32_t value) {
  print_character("0123456789abcdef"[value >> 4 & 15]);
  print_character("0123456789abcdef"[value & 15]);
}

/* what the driver needs of a C library */
void* memcpy(void* to, const void* from, size_t bytes) {
  for (size_t i = 0; i < bytes; ++i) ((volatile char*)to)[i] = ((const char*)from)[i];
  return to;
}

int main(void) {
  struct chip chip = {(volatile uint32_t*)REGISTERS, (volatile uint32_t*)MEMORY, MEMORY, 0, 0, 100000};
  struct chip_record record = {0, 0, 0, 0};
  int code = chip_start(&chip);
  if (code == CHIP_OK) code = chip_submit(&chip, query);
  while (code == CHIP_OK && !chip_is_done(&record)) code = chip_next(&chip, &record);
  print(code == CHIP_OK ? "answer " : "failed ");
  print_byte(code == CHIP_OK ? chip_answer(&record) : (uint32_t)code);
  print(" code ");
  print_byte(chip_code(&record));
  print(" pairs ");
  print_byte(record.second);
  print_character('\n');
  /* The simulation ends. In an empty loop the processor fetches without a pause, and LiteX's arbiter grants no one else
   * the bus before its master pauses: the character would stay in the processor's buffer. */
  for (;;) print_character(4);
}

/* Execution begins here: no data but constants, a stack. */
__attribute__((naked, section(".start"))) void start(void) { __asm__("li sp, %0\n j main" ::"i"(STACK)); }
