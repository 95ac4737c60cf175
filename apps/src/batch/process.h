#pragma once

#include "batch/message.h"

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace hoist {

/** \brief A worker: this program again, in a process of its own, at the other end of a
 *  socket that it finds as descriptor \ref worker_socket. Ends with this object. */
class WorkerProcess {
public:
  static constexpr int worker_socket = 3;

  /** \throws std::system_error if no process can be made */
  explicit WorkerProcess(const std::vector<std::string>& arguments);
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /** \brief To poll for messages. */
  int
  socket() const
  {
    return socket_;
  }

  /** \return false if the worker is gone */
  bool
  send(const Message& message)
  {
    return sendMessage(socket_, message);
  }

  /** \copydoc MessageReader::read */
  bool
  read()
  {
    return reader_.read();
  }

  std::optional<Message>
  take()
  {
    return reader_.take();
  }

  /** \brief Ends the process if it has not ended itself, and says how it ended: "was
   *  killed by signal 11 (SEGV)", "ended with code 1". */
  std::string end();

private:
  int socket_ = -1;
  pid_t process_ = -1;
  MessageReader reader_;
};

} // namespace hoist
