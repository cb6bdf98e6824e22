// SPDX-License-Identifier: Apache-2.0
#include "mpi_crew.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <mpi.h>

namespace burnish::cli {

namespace {

constexpr int kTag = 21;
constexpr std::size_t kPiece = 1 << 28;  // MPI takes counts as int

// Calls use(offset, count) for pieces of at most kPiece bytes.
template <class Use>
void in_pieces(std::size_t size, const Use& use) {
  for (std::size_t at = 0; at < size; at += kPiece) use(at, static_cast<int>(std::min(kPiece, size - at)));
}

}  // namespace

MpiCrew::MpiCrew() {
  MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
}

std::vector<std::string> MpiCrew::gather(const std::string& bytes) {
  const std::uint64_t size = bytes.size();
  std::vector<std::uint64_t> sizes(static_cast<std::size_t>(rank_ == 0 ? ranks_ : 0));
  MPI_Gather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  if (rank_ != 0) {
    in_pieces(size, [&](std::size_t at, int count) {
      MPI_Send(bytes.data() + at, count, MPI_BYTE, 0, kTag, MPI_COMM_WORLD);
    });
    return {};
  }
  std::vector<std::string> all{bytes};
  for (int from = 1; from < ranks_; ++from) {
    std::string& sent = all.emplace_back(sizes[static_cast<std::size_t>(from)], '\0');
    in_pieces(sent.size(), [&](std::size_t at, int count) {
      MPI_Recv(sent.data() + at, count, MPI_BYTE, from, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    });
  }
  return all;
}

std::string MpiCrew::broadcast(const std::string& bytes) {
  std::uint64_t size = bytes.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  std::string sent = bytes;
  sent.resize(size);
  in_pieces(size, [&](std::size_t at, int count) {
    MPI_Bcast(sent.data() + at, count, MPI_BYTE, 0, MPI_COMM_WORLD);
  });
  return sent;
}

}  // namespace burnish::cli
