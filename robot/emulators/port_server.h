#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace rubble::robot {

/// What PortServer::read brought.
struct Served {
  std::size_t size = 0;      ///< bytes taken
  bool client_came = false;  ///< a client connected since the last call (never on a pty: nobody can tell)
  bool client_left = false;  ///< the client closed its end since the last call (never on a pty)
};

/// The device's side of a line: serves one client after another and outlives them all. Of a TCP port one client is
/// served at a time and others are hung up on at once, as by a serial server: who waited in a queue would drive the
/// robot on when the first one stops it. Never blocks and never throws because of what a client does. For one thread.
class PortServer {
 public:
  virtual ~PortServer() = default;
  /// The word that clients give to open_port, with the true port number.
  virtual const std::string& name() const = 0;
  /// Waits up to `timeout` [s] for a client or its bytes, takes at most `size` of them, and sends on what waits.
  virtual Served read(std::uint8_t* to, std::size_t size, double timeout) = 0;
  /// Sends all bytes in one piece or none (false): nobody listens, or the client has not yet taken the last ones.
  virtual bool write(const std::uint8_t* from, std::size_t size) = 0;
  /// For poll(): readable when a client or bytes wait. The same as long as the server lives.
  virtual int descriptor() const = 0;
  /// As if the plug were pulled: the client is cut off and nobody can connect.
  virtual void unplug() = 0;
  /// Plugged in again under the same name. Throws RunError when the name is taken by now.
  virtual void plug_in() = 0;
};

/// Serves `tcp:HOST:PORT` (port 0: any free one) or `pty:PATH` (PATH becomes a link to the pty; an older link is
/// replaced, any other file is left alone). Throws InputError on another word and RunError when the name is taken.
std::unique_ptr<PortServer> serve_port(const std::string& word);

}  // namespace rubble::robot
