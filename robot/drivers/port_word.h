#pragma once

#include <string>

namespace rubble::robot {

enum class PortKind { Serial, Pty, Tcp };

/// The parts of a word that names a port.
struct PortWord {
  PortKind kind = PortKind::Serial;
  std::string path;  ///< of the serial line or of the pty's link
  std::string host;  ///< name or address
  std::string port;  ///< decimal, 0..65535
};

/// Splits `/dev/ttyUSB0`, `pty:PATH` or `tcp:HOST:PORT`; an IPv6 address stands in brackets. Throws InputError.
PortWord parse_port_word(const std::string& word);

}  // namespace rubble::robot
