// SPDX-License-Identifier: MIT
// The user's mistakes. One exception type; tests match its code, people read its text.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace relume {

enum class ErrorCode {
  // status 1: the input is wrong
  kFileNotFound,
  kFileUnreadable,
  kNotGltf,    ///< neither JSON nor a binary glTF
  kTruncated,  ///< shorter than it says
  kInvalidJson,
  kUnsupported,       ///< a required extension or a version that is not known here
  kInvalidReference,  ///< an index or a URI that leads nowhere
  kOutOfBounds,       ///< an accessor or view that leaves its buffer
  kInvalidValue,      ///< a field of the wrong type or range
  kCyclicNodes,
  kEmptyScene,    ///< nothing to work on
  kCorruptAsset,  ///< a bake whose checksum or layout is wrong
  kStale,         ///< a bake or a cache made from other input
  kNoSuchLayer,
  kMismatch,  ///< two inputs that do not belong together
  // other statuses
  kUsage,        ///< 2: wrong options
  kCannotWrite,  ///< 3
  kOutOfMemory,  ///< 4: or over --max-memory
  kInterrupted,  ///< 130
};

/// Exit status of the command line for an error (docs/command-line.md).
int exitStatus(ErrorCode code);
/// Stable name of a code, e.g. "out-of-bounds".
const char* name(ErrorCode code);

/// What is wrong, where, and what would mend it. `what()` is "subject: problem; remedy" on one line.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, std::string subject, std::string problem, std::string remedy = {});

  ErrorCode code() const { return code_; }
  const std::string& subject() const { return subject_; }
  const std::string& problem() const { return problem_; }
  const std::string& remedy() const { return remedy_; }

 private:
  ErrorCode code_;
  std::string subject_, problem_, remedy_;
};

/// Something odd that does not stop the work: same fields as an Error.
struct Warning {
  std::string subject;
  std::string problem;
  std::string remedy;
  std::string text() const;
};
using Warnings = std::vector<Warning>;

}  // namespace relume
