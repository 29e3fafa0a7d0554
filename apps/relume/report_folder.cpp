// SPDX-License-Identifier: MIT
#include "report_folder.h"

#include <unistd.h>

#include <algorithm>
#include <string>
#include <system_error>

#include "files.h"

namespace relume::app {
namespace fs = std::filesystem;

ReportFolder::ReportFolder(fs::path folder) : folder_(std::move(folder)) {
  std::error_code ec;
  for (fs::path p = fs::absolute(folder_).lexically_normal(); !p.empty() && !fs::exists(p, ec);
       p = p.parent_path())
    made_.insert(made_.begin(), p);
  makeFolder(folder_);
  draft_ = folder_ / (".draft-" + std::to_string(::getpid()));
  makeFolder(draft_);
}

ReportFolder::~ReportFolder() {
  std::error_code ec;
  fs::remove_all(draft_, ec);
  for (auto p = made_.rbegin(); p != made_.rend(); ++p) fs::remove(*p, ec);  // only where it is empty
}

void ReportFolder::publish() {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(draft_)) files.push_back(entry.path());
  // The page comes last: who sees it finds its pictures.
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return std::pair(a.extension() == ".html", a) < std::pair(b.extension() == ".html", b);
  });
  for (const fs::path& file : files) {
    std::error_code ec;
    fs::rename(file, folder_ / file.filename(), ec);
    if (ec)
      throw Error(ErrorCode::kCannotWrite, (folder_ / file.filename()).string(), ec.message(),
                  "remove what is in its place");
  }
  made_.clear();
}

}  // namespace relume::app
