#pragma once

#include <array>
#include <cstring>

/// Eight double-precision lanes, the unit in which sums over neighbours are formed.
///
/// Each lane keeps its own partial sum and sum() adds the lanes in a fixed order, so a vectorised sum has the
/// same bits on any number of threads and needs no licence for the compiler to reassociate. Arithmetic works
/// element by element, and select(mask, a, b) chooses.
namespace sphvv::solver {

constexpr int lane_count = 8;

/// Four lanes, by the vector extension of GCC and Clang. A vector of eight would live in memory wherever the
/// processor has no register as wide, at twice the time of a pair.
using Half = double __attribute__((vector_size(lane_count / 2 * sizeof(double))));

/// What a comparison of lanes yields.
struct LaneMask {
    using HalfMask = decltype(Half{} < Half{});
    HalfMask low;
    HalfMask high;

    friend LaneMask operator&(LaneMask a, LaneMask b) { return {a.low & b.low, a.high & b.high}; }
};

struct Lanes {
    Half low{};
    Half high{};

    Lanes() = default;
    Lanes(Half first, Half second) : low(first), high(second) {}
    // Not explicit: in a formula a number stands for eight of it.
    Lanes(double all) : low{all, all, all, all}, high(low) {}

    double operator[](int lane) const { return lane < 4 ? low[lane] : high[lane - 4]; }

    friend Lanes operator-(Lanes a) { return {-a.low, -a.high}; }
    friend Lanes operator+(Lanes a, Lanes b) { return {a.low + b.low, a.high + b.high}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {a.low - b.low, a.high - b.high}; }
    friend Lanes operator*(Lanes a, Lanes b) { return {a.low * b.low, a.high * b.high}; }
    friend Lanes operator/(Lanes a, Lanes b) { return {a.low / b.low, a.high / b.high}; }
    friend Lanes& operator+=(Lanes& a, Lanes b) { return a = a + b; }

    friend LaneMask operator<(Lanes a, Lanes b) { return {a.low < b.low, a.high < b.high}; }
    friend LaneMask operator>(Lanes a, Lanes b) { return b < a; }
    friend LaneMask operator!=(Lanes a, Lanes b) { return {a.low != b.low, a.high != b.high}; }
};

/// a where the mask is set, b elsewhere.
inline Lanes select(LaneMask mask, Lanes a, Lanes b) {
    return {mask.low ? a.low : b.low, mask.high ? a.high : b.high};
}

inline Lanes load(const double* p) {
    Lanes v;
    std::memcpy(&v.low, p, sizeof v.low);
    std::memcpy(&v.high, p + lane_count / 2, sizeof v.high);
    return v;
}

inline void store(double* p, Lanes v) {
    std::memcpy(p, &v.low, sizeof v.low);
    std::memcpy(p + lane_count / 2, &v.high, sizeof v.high);
}

/// function(0), …, function(7).
template <class Function>
Lanes lanes_of(const Function& function) {
    std::array<double, lane_count> values;
    for (int lane = 0; lane < lane_count; ++lane) {
        values[lane] = function(lane);
    }
    return load(values.data());
}

/// The values of a field at eight neighbours.
inline Lanes gather(const double* field, const int* index) {
    return {Half{field[index[0]], field[index[1]], field[index[2]], field[index[3]]},
            Half{field[index[4]], field[index[5]], field[index[6]], field[index[7]]}};
}

inline Lanes sqrt(Lanes v) {
    return lanes_of([&](int lane) { return __builtin_sqrt(v[lane]); });
}

inline double sum(Lanes v) {
    const Half pairs = v.low + v.high;
    return (pairs[0] + pairs[1]) + (pairs[2] + pairs[3]);
}

} // namespace sphvv::solver
