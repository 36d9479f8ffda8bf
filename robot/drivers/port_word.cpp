#include "robot/drivers/port_word.h"

#include <charconv>

#include "base/error.h"
#include "robot/drivers/port.h"

namespace rubble::robot {
namespace {

constexpr const char* kForms = "give /dev/ttyUSB0, pty:PATH or tcp:HOST:PORT";

bool starts_with(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

bool is_port_number(const std::string& text) {
  int number = -1;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
  return end.ec == std::errc() && end.ptr == text.data() + text.size() && number >= 0 && number <= 65535;
}

PortWord parse_tcp(const std::string& word) {
  const std::string rest = word.substr(4);
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string::npos || colon == 0)
    throw InputError("port '" + word + "': host or port number is missing; write it as tcp:127.0.0.1:10940");
  PortWord result;
  result.kind = PortKind::Tcp;
  result.host = rest.substr(0, colon);
  result.port = rest.substr(colon + 1);
  const bool bracketed = result.host.size() > 2 && result.host.front() == '[' && result.host.back() == ']';
  if (bracketed) result.host = result.host.substr(1, result.host.size() - 2);
  if (!bracketed && result.host.find(':') != std::string::npos)
    throw InputError("port '" + word + "': '" + result.host +
                     "' is no host; write it as tcp:127.0.0.1:10940, an IPv6 address as tcp:[::1]:10940");
  if (!is_port_number(result.port))
    throw InputError("port '" + word + "': '" + result.port + "' is no port number; give one from 0 to 65535");
  return result;
}

}  // namespace

PortWord parse_port_word(const std::string& word) {
  if (starts_with(word, "tcp:")) return parse_tcp(word);
  PortWord result;
  result.kind = starts_with(word, "pty:") ? PortKind::Pty : PortKind::Serial;
  result.path = result.kind == PortKind::Pty ? word.substr(4) : word;
  if (result.path.empty()) throw InputError("port '" + word + "': the path is missing; " + kForms);
  if (result.kind == PortKind::Serial && result.path.find('/') == std::string::npos)
    throw InputError("port '" + word + "': is no port; " + kForms);
  return result;
}

void check_port_word(const std::string& word) {
  const PortWord port = parse_port_word(word);
  if (port.kind == PortKind::Tcp && port.port.find_first_not_of('0') == std::string::npos)
    throw InputError("port '" + word + "': nobody can be reached at port number 0; give the one that the device has");
}

}  // namespace rubble::robot
