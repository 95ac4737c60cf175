#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace hoist {

/** \brief What the batch and its workers tell each other: a few byte strings. */
using Message = std::vector<std::string>;

/** \brief Sends a whole message over a socket, waiting as long as it takes.
 *  \return false if the other end is gone */
bool sendMessage(int socket, const Message& message);

/** \brief Takes messages off a socket, whatever the pieces they come in. */
class MessageReader {
public:
  explicit MessageReader(int socket) : socket_(socket) {}

  /** \brief Waits for the next message; none if the other end is gone. */
  std::optional<Message> wait();

  /** \brief Reads what has arrived, without waiting.
   *  \return false if the other end is gone or talks nonsense */
  bool read();

  /** \brief The next whole message of what has been read. */
  std::optional<Message> take();

private:
  bool fill(int flags);

  int socket_;
  std::string bytes_;
  bool broken_ = false;
};

} // namespace hoist
