// SPDX-License-Identifier: MIT
#include "relume/core/version.h"
namespace relume {
const char* version() { return RELUME_VERSION; }
}  // namespace relume
