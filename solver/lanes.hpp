#pragma once

#include <cstring>

/// Eight double-precision lanes, the unit in which sums over neighbours are formed.
///
/// Each lane keeps its own partial sum and sum() adds the lanes in a fixed order, so a vectorised sum has the
/// same bits on any number of threads and needs no licence for the compiler to reassociate. The type is the
/// vector extension of GCC and Clang: arithmetic works element by element, and `mask ? a : b` selects.
namespace sphvv::solver {

constexpr int lane_count = 8;
using Lanes = double __attribute__((vector_size(lane_count * sizeof(double))));

inline Lanes load(const double* p) {
    Lanes v;
    std::memcpy(&v, p, sizeof v);
    return v;
}

inline void store(double* p, Lanes v) {
    std::memcpy(p, &v, sizeof v);
}

/// The values of a field at eight neighbours.
inline Lanes gather(const double* field, const int* index) {
    return Lanes{field[index[0]], field[index[1]], field[index[2]], field[index[3]],
                 field[index[4]], field[index[5]], field[index[6]], field[index[7]]};
}

inline double sum(Lanes v) {
    return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

} // namespace sphvv::solver
