// SPDX-License-Identifier: Apache-2.0
/// \file
/// All of cchip::rc.
#ifndef CCHIP_RC_RC_HPP
#define CCHIP_RC_RC_HPP

#include <cchip/rc/bitstream_timing.hpp>
#include <cchip/rc/context.hpp>
#include <cchip/rc/control.hpp>
#include <cchip/rc/event_portal.hpp>
#include <cchip/rc/fifo_portal.hpp>
#include <cchip/rc/group.hpp>
#include <cchip/rc/portal.hpp>
#include <cchip/rc/resettable.hpp>
#include <cchip/rc/resolved_portal.hpp>
#include <cchip/rc/signal_portal.hpp>
#include <cchip/rc/timed_control.hpp>
#include <cchip/rc/tlm_portal.hpp>
#include <cchip/rc/transaction.hpp>

#endif
