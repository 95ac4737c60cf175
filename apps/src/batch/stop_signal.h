#pragma once

namespace hoist {

/** \brief From here on SIGINT, SIGTERM and SIGHUP do not end the program but make this
 *  object say so. One at a time. */
class StopSignal {
public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  /** \brief The signal's number, 0 as long as there was none. */
  int received() const;

  /** \brief Readable once a signal has come; for poll(). */
  int descriptor() const;
};

} // namespace hoist
