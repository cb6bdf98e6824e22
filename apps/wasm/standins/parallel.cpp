// In place of math/parallel.cpp: one thread, chunks in their order. Results are the same for every number of threads.
#include <algorithm>

#include <burnish/math/parallel.h>

namespace burnish {

void for_each_chunk(std::size_t count, std::size_t chunk_size,
                    const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
  for (std::size_t chunk = 0; chunk < chunk_count(count, chunk_size); ++chunk)
    body(chunk, chunk * chunk_size, std::min(count, (chunk + 1) * chunk_size));
}

ThreadLimit::ThreadLimit(int) {}

ThreadLimit::~ThreadLimit() {}

}  // namespace burnish
