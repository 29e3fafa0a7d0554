// SPDX-License-Identifier: MIT
// The calls of Embree that differ between its versions 3 and 4, under one name each. `Coherence::kSorted` is
// for packets whose rays point much the same way; it makes unsorted packets slower.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace relume::trace::embree {

enum class Coherence { kNone, kSorted };

#if RTC_VERSION_MAJOR >= 4

inline RTCRayQueryFlags flagsOf(Coherence c) {
  return c == Coherence::kSorted ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
}
inline RTCIntersectArguments intersectArguments(Coherence c) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = flagsOf(c);
  return arguments;
}
inline RTCOccludedArguments occludedArguments(Coherence c) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = flagsOf(c);
  return arguments;
}
inline void intersect1(RTCScene scene, RTCRayHit& ray) {
  RTCIntersectArguments arguments = intersectArguments(Coherence::kNone);
  rtcIntersect1(scene, &ray, &arguments);
}
inline void occluded1(RTCScene scene, RTCRay& ray) {
  RTCOccludedArguments arguments = occludedArguments(Coherence::kNone);
  rtcOccluded1(scene, &ray, &arguments);
}
inline void intersect16(const int* valid, RTCScene scene, RTCRayHit16& rays, Coherence c) {
  RTCIntersectArguments arguments = intersectArguments(c);
  rtcIntersect16(valid, scene, &rays, &arguments);
}
inline void occluded16(const int* valid, RTCScene scene, RTCRay16& rays, Coherence c) {
  RTCOccludedArguments arguments = occludedArguments(c);
  rtcOccluded16(valid, scene, &rays, &arguments);
}

#else

inline RTCIntersectContext contextOf(Coherence c) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags =
      c == Coherence::kSorted ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}
inline void intersect1(RTCScene scene, RTCRayHit& ray) {
  RTCIntersectContext context = contextOf(Coherence::kNone);
  rtcIntersect1(scene, &context, &ray);
}
inline void occluded1(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context = contextOf(Coherence::kNone);
  rtcOccluded1(scene, &context, &ray);
}
inline void intersect16(const int* valid, RTCScene scene, RTCRayHit16& rays, Coherence c) {
  RTCIntersectContext context = contextOf(c);
  rtcIntersect16(valid, scene, &context, &rays);
}
inline void occluded16(const int* valid, RTCScene scene, RTCRay16& rays, Coherence c) {
  RTCIntersectContext context = contextOf(c);
  rtcOccluded16(valid, scene, &context, &rays);
}

#endif

}  // namespace relume::trace::embree
