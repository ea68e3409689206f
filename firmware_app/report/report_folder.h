#pragma once

#include <memory>
#include <string>

#include "drivers/storage/folder_claim.h"

namespace app {

// The folder of a report. A run writes into its subfolder `report.partial`; hand_over() puts these files into the place
// of the last report's, which becomes `report.1`, the one before it `report.2`, and so on. Other files in the folder
// stay. A run that is killed before leaves the last report as it was; one that is killed in hand_over() leaves names
// from which the next construction completes it. Used by one thread.
class ReportFolder {
 public:
  // keep: earlier reports that are kept. Claims the folder (drivers::FolderClaim); completes a hand-over that was
  // interrupted; renames what a killed run left to `report.unfinished`, where the larger of two stays.
  // Throws drivers::FileError, drivers::FolderInUse.
  ReportFolder(const std::string& directory, int keep);
  // Removes what is in working() unless keep_unfinished() was called: nothing remains of a run without a frame.
  ~ReportFolder();
  ReportFolder(const ReportFolder&) = delete;
  ReportFolder& operator=(const ReportFolder&) = delete;

  [[nodiscard]] const std::string& directory() const noexcept { return directory_; }
  [[nodiscard]] const std::string& working() const noexcept { return working_; }  // where files are written
  [[nodiscard]] std::string in_working(const char* name) const { return working_ + "/" + name; }
  [[nodiscard]] bool has_report() const;  // a complete one, of an earlier run
  void keep_unfinished() noexcept { is_kept_ = true; }
  // What an earlier run left unfinished, in words; empty: nothing.
  [[nodiscard]] const std::string& remark() const noexcept { return remark_; }

  // Frees the space that is held for the smaller files of a report, so that a full disk costs the large ones only.
  void free_reserve() noexcept;
  // The files in working() become the report. Throws drivers::FileError.
  void hand_over();

 private:
  std::string directory_, working_, remark_;
  int keep_;
  std::shared_ptr<drivers::FolderClaim> claim_;
  bool is_kept_ = false;
};

}  // namespace app
