#include "slam/process/mapper_server.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <stdexcept>

#include "base/error.h"
#include "base/yaml/binder.h"
#include "slam/mappers.h"
#include "slam/process/answer.h"
#include "slam/process/request.h"

namespace rubble::slam {
namespace {

bool serves = false;

void write_all(int descriptor, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t sent = write(descriptor, text.data() + at, text.size() - at);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) throw RunError("the other side takes no more answers");
    at += static_cast<std::size_t>(sent);
  }
}

AnsweredMap whole_map(const CountMap& map) {
  const GridFrame& frame = map.frame();
  AnsweredMap answered{frame, std::vector<std::uint16_t>(frame.size(), 0), std::vector<std::uint16_t>(frame.size(), 0)};
  for (int y = 0; y < frame.height; ++y)
    map.for_seen(y, 0, frame.width, [&](int x, int count, const std::uint16_t* seen, const std::uint16_t* occupied) {
      std::copy_n(seen, count, &answered.seen[frame.index({x, y})]);
      std::copy_n(occupied, count, &answered.occupied[frame.index({x, y})]);
    });
  return answered;
}

/// What the other side knows already, so that only news are told.
class Teller {
 public:
  MapperAnswer news(const Mapper& mapper) {
    MapperAnswer answer;
    answer.pose = mapper.pose();
    answer.covariance = mapper.covariance();
    const Trajectory& live = mapper.live_trajectory();
    answer.at.assign(live.begin() + static_cast<std::ptrdiff_t>(poses_), live.end());
    poses_ = live.size();
    if (mapper.revision() != revision_) answer.corrected = mapper.trajectory();
    revision_ = mapper.revision();
    answer.mapped = mapper.counts().mapped;
    if (mapper.settled() != settled_) answer.settled = mapper.settled();
    settled_ = mapper.settled();
    if (mapper.blind_way() != blind_way_) answer.blind_way = mapper.blind_way();
    blind_way_ = mapper.blind_way();
    answer.figures = mapper.figures();
    if (mapper.map().version() != version_) answer.map = whole_map(mapper.map());
    version_ = mapper.map().version();
    return answer;
  }

 private:
  std::size_t poses_ = 0;
  std::uint64_t revision_ = 0;
  std::uint64_t version_ = 0;
  bool settled_ = true;
  double blind_way_ = 0.0;
};

}  // namespace

void serve_mapper(const std::string& kind, int input, int output) {
  MapperConfig config;
  config.choose(kind);
  DescriptorSource source(input);
  MessageReader in(source);
  const MapperHeader header = read_header(in);
  const YamlMap parameters = YamlMap::parse(header.parameters.empty() ? "{}" : header.parameters, "parameters");
  YamlReader reader(parameters);
  config.bind(reader);
  parameters.finish();
  const std::unique_ptr<Mapper> mapper = make_here(config, header.model, {header.seed, ""});
  std::string text;
  append_ready(text);
  write_all(output, text);
  Teller teller;
  while (const std::optional<MapperRequest> request = read_request(in)) {
    if (request->finish) {
      mapper->finish();
    } else {
      mapper->update(request->inputs);
    }
    text.clear();
    append_answer(text, teller.news(*mapper));
    write_all(output, text);
  }
}

std::optional<int> serve_mapper_if_asked(int argc, char** argv) {
  serves = true;
  if (argc != 3 || std::string(argv[1]) != "mapper-process") return std::nullopt;
  // Libraries print to the standard output; the protocol keeps the one it was given for itself.
  const int output = dup(STDOUT_FILENO);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  try {
    serve_mapper(argv[2], STDIN_FILENO, output);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rubble mapper-process: %s\n", error.what());
    return 4;
  }
}

bool program_serves_mappers() { return serves; }

}  // namespace rubble::slam
