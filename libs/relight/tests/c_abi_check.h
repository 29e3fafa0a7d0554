/* SPDX-License-Identifier: MIT */
#pragma once
#include <stddef.h>

#ifdef __cplusplus
extern "C"
#endif
    int
    checkCAbi(const void* glb, size_t size);
