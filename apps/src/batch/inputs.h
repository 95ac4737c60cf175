#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hoist {

/** \brief One file of a batch. */
struct InputFile {
  std::string path; ///< to open it
  /// Where its record lies below the folder of results, without its ending: the path
  /// without its root. The same for every spelling of the path, whatever else is in
  /// the batch.
  std::string name;
};

/** \brief What the user named. */
struct InputRequest {
  /// Files, folders (all clouds below), patterns with * ? [], "-" for a list on stdin.
  std::vector<std::string> inputs;
  /// Files that list inputs' paths, one per line, or separated by NUL where one occurs.
  std::vector<std::string> manifests;
  std::string out; ///< left out where it lies in a named folder
};

/** \brief All files of a batch, each once, in the order of their names.
 *
 * Folders give files that end in .pcd, .ply, .pts, .xyz or .asc, in any case. A file
 * that is named but missing is an error; one that a list names is kept, so that it gets
 * a record that says so.
 * \throws UsageError
 */
std::vector<InputFile> expandInputs(const InputRequest& request);

/** \brief The name of a path's record. */
std::string recordName(const std::string& path);

/** \brief Whether shard \a k of \a n (from 1) does the file. By the hash of the name,
 *  so that it does not depend on which other files there are. */
bool inShard(const std::string& name, std::size_t k, std::size_t n);

} // namespace hoist
