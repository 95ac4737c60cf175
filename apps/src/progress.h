#pragma once

#include <cstddef>
#include <string>

namespace hoist {

/** \brief Says on stderr how far a run over many files is: one line that is rewritten
 *  on a terminal, a plain line per file elsewhere. */
class Progress {
public:
  Progress(std::size_t total, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void begin(const std::string& name);

  /** \brief \a note is for the plain line, e.g. "3 cuboids, 41 ms". */
  void end(const std::string& note);

  /** \brief Takes the line off a terminal, so that something else can be printed. */
  void clear();

private:
  std::size_t total_;
  std::size_t number_ = 0;
  std::string name_;
  bool quiet_;
  bool terminal_;
};

} // namespace hoist
