#include <cmath>
#include <utility>

#include <burnish/error.h>
#include <burnish/math/envelope_matrix.h>

namespace burnish {

namespace {

// Four sums side by side: the processor does not wait for one addition before the next.
double dot(const double* a, const double* b, std::size_t n) noexcept {
  double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    s0 += a[i] * b[i];
    s1 += a[i + 1] * b[i + 1];
    s2 += a[i + 2] * b[i + 2];
    s3 += a[i + 3] * b[i + 3];
  }
  for (; i < n; ++i) s0 += a[i] * b[i];
  return (s0 + s1) + (s2 + s3);
}

}  // namespace

EnvelopeMatrix::EnvelopeMatrix(std::vector<std::size_t> first) : first_(std::move(first)) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < first_.size(); ++i) {
    begin_.push_back(count);
    count += i - first_[i] + 1;
  }
  values_.resize(count);
}

void EnvelopeMatrix::factor() {
  for (std::size_t i = 0; i < size(); ++i) {
    double* const own = values_.data() + begin_[i];
    for (std::size_t j = first_[i]; j <= i; ++j) {
      const std::size_t from = first_[i] > first_[j] ? first_[i] : first_[j];
      double& entry = own[j - first_[i]];
      entry -= dot(own + (from - first_[i]), row(j) + (from - first_[j]), j - from);
      if (j < i) {
        entry /= row(j)[j - first_[j]];
      } else {
        if (!(entry > 0)) throw Error("least squares: expected a positive definite matrix");
        entry = std::sqrt(entry);
      }
    }
  }
}

void EnvelopeMatrix::solve(std::span<double> right) const noexcept {
  for (std::size_t i = 0; i < size(); ++i)
    right[i] = (right[i] - dot(row(i), right.data() + first_[i], i - first_[i])) / row(i)[i - first_[i]];
  for (std::size_t i = size(); i-- > 0;) {
    right[i] /= row(i)[i - first_[i]];
    for (std::size_t j = first_[i]; j < i; ++j) right[j] -= row(i)[j - first_[i]] * right[i];
  }
}

}  // namespace burnish
