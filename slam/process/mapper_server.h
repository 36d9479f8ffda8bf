#pragma once

#include <optional>
#include <string>

namespace rubble::slam {

/// Serves one of our own kinds of mappers over two descriptors, by the protocol of docs/mapper_protocol.md, until the
/// other side closes: the parameters of the header are the kind's YAML. Throws BadMessage, InputError.
void serve_mapper(const std::string& kind, int input, int output);

/// `PROGRAM mapper-process KIND` serves that kind over standard input and output: returns the exit code then, nothing
/// otherwise. Called first of all by a program whose mappers may need a process of their own (mrpt-icp, mrpt-rbpf):
/// they start the same program again.
std::optional<int> serve_mapper_if_asked(int argc, char** argv);

/// Whether this program called serve_mapper_if_asked().
bool program_serves_mappers();

}  // namespace rubble::slam
