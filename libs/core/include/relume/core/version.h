// SPDX-License-Identifier: MIT
#pragma once
namespace relume {
const char* version();  ///< e.g. "0.1.0"
}
