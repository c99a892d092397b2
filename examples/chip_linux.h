// SPDX-License-Identifier: Apache-2.0
/* Ports of chip_poll.h on Linux, over UIO, AMD's XDMA and VFIO: see docs/hardware/uio.md. No board has run them. */
#ifndef CHIP_LINUX_H
#define CHIP_LINUX_H

#include "chip_poll.h"

#ifdef __cplusplus
extern "C" {
#endif

struct chip_linux {
  struct chip_port port; /* for struct chip; its context is this object, which must not move */
  int registers, events; /* files; -1: none */
  int to_card, from_card;
  int container, group;  /* of VFIO */
  volatile uint32_t *register_words, *memory_words; /* mappings; null over XDMA */
  uint64_t address;                                 /* of the memory on the card, over XDMA */
  uint32_t bytes;                                   /* of the memory */
  int arms;                                         /* 1: an interrupt is masked until a 1 is written to `events` */
  uint32_t event_bytes;                             /* of a count that `events` gives */
  char error[160];                                  /* what failed at opening, with the text of errno */
};

/* Registers (4 KiB) and interrupt of a UIO file, and the memory that another file maps: `bytes` from `offset` on, a
 * multiple of the page size. Any file that maps the registers will do, without an interrupt. Not 0: what failed is in
 * `error` and errno, and nothing is open. */
int chip_open_uio(struct chip_linux *l, const char *registers, const char *memory, uint64_t offset, uint32_t bytes);

/* The files of a card, `name` is "/dev/xdma0": <name>_user has the registers at its beginning, <name>_h2c_0 and
 * <name>_c2h_0 carry the memory, `bytes` from `address` of the card on, <name>_events_0 is the interrupt; without that
 * file the chip is polled. */
int chip_open_xdma(struct chip_linux *l, const char *name, uint64_t address, uint32_t bytes);

/* A PCI device that is bound to vfio-pci: `group` is "/dev/vfio/26", `device` "0000:01:00.0". BAR `bar` has the registers
 * at its beginning. The memory is `bytes` of this process, which the device reaches from `address` on, both multiples of
 * the page size. The interrupt is the first MSI or MSI-X; without either the chip is polled. */
int chip_open_vfio(struct chip_linux *l, const char *group, const char *device, uint32_t bar, uint64_t address,
                   uint32_t bytes);

void chip_close(struct chip_linux *l);

#ifdef __cplusplus
}
#endif

#endif
