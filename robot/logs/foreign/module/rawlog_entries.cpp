#include "robot/logs/foreign/module/rawlog_entries.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <new>

#include "base/error.h"
#include "base/text/words.h"

namespace rubble::robot {
namespace {

// MRPT's messages run over many lines with a call stack each; the innermost "Message:" says what happened.
std::string reason_of(const std::string& text) {
  constexpr std::string_view kMark = "Message:";
  const std::size_t mark = text.rfind(kMark);
  std::string line = mark == std::string::npos ? text : text.substr(mark + kMark.size());
  line = line.substr(0, line.find('\n'));
  line.erase(0, line.find_first_not_of(' '));
  return one_line(line.substr(0, 200));
}

}  // namespace

void each_rawlog_entry(std::string_view bytes, const std::string& path,
                       const std::function<void(std::size_t, const mrpt::serialization::CSerializable::Ptr&)>& visit) {
  mrpt::io::CMemoryStream stream;
  stream.assignMemoryNotOwn(bytes.data(), bytes.size());
  auto archive = mrpt::serialization::archiveFrom(stream);
  for (std::size_t entry = 0; stream.getPosition() < bytes.size(); ++entry) {
    const std::uint64_t start = stream.getPosition();
    mrpt::serialization::CSerializable::Ptr object;
    const std::string place =
        path + ": entry " + std::to_string(entry) + " (byte " + std::to_string(start) + " of the uncompressed rawlog)";
    try {
      object = archive.ReadObject();
    } catch (const std::bad_alloc&) {
      throw InputError(place + ": asks for more memory than the file can hold; copy the file again");
    } catch (const std::exception& e) {
      if (stream.getPosition() >= bytes.size())
        throw InputError(place + ": the rawlog ends in the middle of this entry, " + std::to_string(entry) +
                         " whole ones precede it; copy the file again");
      throw InputError(place + ": cannot be understood (" + reason_of(e.what()) +
                       "); check the file with: rawlog-edit --info -i");
    }
    if (object) visit(entry, object);
  }
}

}  // namespace rubble::robot
