// include/obscura/obscura.h - all of the library.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "obscura/session.h"
