// SPDX-License-Identifier: MIT
// The folder of a report. Its files appear together when all are written, or not at all.
#pragma once
#include <filesystem>
#include <vector>

namespace relume::app {

class ReportFolder {
 public:
  /// Makes the folder where there is none. Throws Error kCannotWrite unless files can be made in it.
  explicit ReportFolder(std::filesystem::path folder);
  /// Unless published, removes what was written, and the folder where it was made for this.
  ~ReportFolder();
  ReportFolder(const ReportFolder&) = delete;
  ReportFolder& operator=(const ReportFolder&) = delete;

  /// Where to write until then.
  const std::filesystem::path& draft() const { return draft_; }
  /// Moves every file of the draft into the folder. Throws Error kCannotWrite.
  void publish();

 private:
  std::filesystem::path folder_, draft_;
  std::vector<std::filesystem::path> made_;  ///< folders that did not exist before, outermost first
};

}  // namespace relume::app
