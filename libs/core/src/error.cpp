// SPDX-License-Identifier: MIT
#include "relume/core/error.h"

#include "relume/core/progress.h"

namespace relume {

int exitStatus(ErrorCode code) {
  switch (code) {
    case ErrorCode::kUsage:
      return 2;
    case ErrorCode::kCannotWrite:
      return 3;
    case ErrorCode::kOutOfMemory:
      return 4;
    case ErrorCode::kInterrupted:
      return 130;
    default:
      return 1;
  }
}

const char* name(ErrorCode code) {
  switch (code) {
    case ErrorCode::kFileNotFound:
      return "file-not-found";
    case ErrorCode::kFileUnreadable:
      return "file-unreadable";
    case ErrorCode::kNotGltf:
      return "not-gltf";
    case ErrorCode::kTruncated:
      return "truncated";
    case ErrorCode::kInvalidJson:
      return "invalid-json";
    case ErrorCode::kUnsupported:
      return "unsupported";
    case ErrorCode::kInvalidReference:
      return "invalid-reference";
    case ErrorCode::kOutOfBounds:
      return "out-of-bounds";
    case ErrorCode::kInvalidValue:
      return "invalid-value";
    case ErrorCode::kCyclicNodes:
      return "cyclic-nodes";
    case ErrorCode::kEmptyScene:
      return "empty-scene";
    case ErrorCode::kCorruptAsset:
      return "corrupt-asset";
    case ErrorCode::kStale:
      return "stale";
    case ErrorCode::kNoSuchLayer:
      return "no-such-layer";
    case ErrorCode::kMismatch:
      return "mismatch";
    case ErrorCode::kUsage:
      return "usage";
    case ErrorCode::kCannotWrite:
      return "cannot-write";
    case ErrorCode::kOutOfMemory:
      return "out-of-memory";
    case ErrorCode::kInterrupted:
      return "interrupted";
  }
  return "unknown";
}

namespace {
std::string oneLine(const std::string& subject, const std::string& problem, const std::string& remedy) {
  std::string line = subject.empty() ? problem : subject + ": " + problem;
  if (!remedy.empty()) line += "; " + remedy;
  for (char& c : line)
    if (c == '\n' || c == '\r') c = ' ';
  return line;
}
}  // namespace

Error::Error(ErrorCode code, std::string subject, std::string problem, std::string remedy)
    : std::runtime_error(oneLine(subject, problem, remedy)),
      code_(code),
      subject_(std::move(subject)),
      problem_(std::move(problem)),
      remedy_(std::move(remedy)) {}

std::string Warning::text() const { return oneLine(subject, problem, remedy); }

void Progress::throwIfCancelled() const {
  if (cancelled()) throw Error(ErrorCode::kInterrupted, "", "interrupted");
}

}  // namespace relume
