// SPDX-License-Identifier: MIT
// How the program takes memory from the system.
#pragma once

namespace relume::app {

/// Lets the allocator keep what is freed and take its first room in large pages: a bake frees and fills again
/// some megabytes stage after stage, and a page of 4 kB that is new costs as much as filling it several
/// times. Only addresses are reserved, memory is used as it is needed. Before the first thread starts.
void prepareHeap();

}  // namespace relume::app
