#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pellucid {

// The readers of read_apart(), by assimp and OpenVDB. Each takes apart the request that its caller has made.
std::vector<std::byte> read_3ds_here(std::span<const std::byte> request);
[[gnu::visibility("hidden")]] std::vector<std::byte> read_vdb_here(std::span<const std::byte> request);

}  // namespace pellucid
