#include "batch/message.h"

#include <sys/socket.h>
#include <sys/types.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

namespace hoist {
namespace {

// A worker gone mad must not make the batch ask for the machine's memory.
constexpr std::uint64_t longest = std::uint64_t(1) << 28;

void
append(std::string& bytes, std::uint64_t number)
{
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::uint64_t
numberAt(const std::string& bytes, std::size_t position)
{
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data() + position, sizeof number);
  return number;
}

} // namespace

// Layout: bytes that follow, then per string its length and its bytes. Both ends are
// one program on one machine: no byte order to agree on.
bool
sendMessage(int socket, const Message& message)
{
  std::string body;
  for (const std::string& part : message) {
    append(body, part.size());
    body += part;
  }
  std::string bytes;
  append(bytes, body.size());
  bytes += body;
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t n =
        ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      return false;
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

bool
MessageReader::fill(int flags)
{
  constexpr std::size_t block = std::size_t(1) << 18;
  const std::size_t old = bytes_.size();
  bytes_.resize(old + block);
  ssize_t n = 0;
  do
    n = ::recv(socket_, &bytes_[old], block, flags);
  while (n < 0 && errno == EINTR);
  bytes_.resize(old + (n > 0 ? static_cast<std::size_t>(n) : 0));
  if (n == 0 || (n < 0 && errno != EAGAIN && errno != EWOULDBLOCK))
    return false;
  return true;
}

std::optional<Message>
MessageReader::wait()
{
  for (;;) {
    if (std::optional<Message> message = take())
      return message;
    if (broken_ || !fill(0))
      return std::nullopt;
  }
}

bool
MessageReader::read()
{
  return !broken_ && fill(MSG_DONTWAIT);
}

std::optional<Message>
MessageReader::take()
{
  constexpr std::size_t word = sizeof(std::uint64_t);
  if (broken_ || bytes_.size() < word)
    return std::nullopt;
  const std::uint64_t length = numberAt(bytes_, 0);
  if (length > longest) {
    broken_ = true;
    return std::nullopt;
  }
  if (bytes_.size() - word < length)
    return std::nullopt;
  Message message;
  const std::size_t end = word + length;
  for (std::size_t position = word; position < end;) {
    if (end - position < word || numberAt(bytes_, position) > end - position - word) {
      broken_ = true;
      return std::nullopt;
    }
    const std::uint64_t size = numberAt(bytes_, position);
    message.push_back(bytes_.substr(position + word, size));
    position += word + size;
  }
  bytes_.erase(0, end);
  return message;
}

} // namespace hoist
