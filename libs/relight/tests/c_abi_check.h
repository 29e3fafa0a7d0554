/* SPDX-License-Identifier: MIT */
#pragma once
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif
/* Each returns 0, or the line of the check that failed. */
int checkObscuranceFromC(const void* glb, size_t size);
/* expected: [texels][3], what evaluating a point light of 10 cd at (2, 1.5, 2.5) gives whose light every
 * second point sees */
int checkTransferFromC(const void* glb, size_t size, const float* expected);
/* Two texels; groups "a" with 1, 2, 3 and "b" with 10, 20, 30 */
int checkGroupsFromC(const void* glb, size_t size);
#ifdef __cplusplus
}
#endif
