#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "engine/io/store/object_store.h"
#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/options/sequence_layout.h"

namespace vantage::apps {

/// Keeps the results of a run, which works in a folder of this machine, in a store: files first,
/// then the journal that tells of them, so that what a store has is a run that can be resumed.
/// Files of frames that are kept take no more room here. Thread rule: one thread at a time.
class ResultMirror {
 public:
  /// Keys are `prefix` and the names of the files below the layout's folder. `part`: of the run, as
  /// its journal names it; empty: all parts. Both must outlive it.
  ResultMirror(ObjectStore& store, std::string prefix, const SequenceLayout& layout,
               std::string part);

  /// Brings here what a run needs to go on: journals, segments of videos, and empty files in place
  /// of results that are done. Throws Error.
  void fetch();
  /// Puts what the journal tells of and is not kept yet. Throws Error, also where a file is there
  /// that this run did not make.
  void keep();
  /// keep(); after a run of all parts also removes the segments that it has joined from the store.
  /// Throws Error.
  void finish();

 private:
  [[nodiscard]] std::vector<std::string> journal_files() const;
  void fetch_file(const std::string& name);
  /// An empty file of its size, for one that is kept.
  void stand_in_for(const FileRecord& file);
  void keep_file(const std::string& name, const FileContent& content, bool is_of_frame);

  ObjectStore& store_;
  std::string prefix_;
  const SequenceLayout& layout_;
  std::string part_;
  std::set<std::string> kept_;
};

/// Puts a result unless it is there already with this content. Throws Error where another one is.
void put_result(ObjectStore& store, const std::string& key, const std::filesystem::path& file,
                const FileContent& content);

}  // namespace vantage::apps
