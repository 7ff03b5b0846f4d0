#include "sphvv/verification/norms.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace sphvv::verification {
namespace {

using Field = std::span<const double>;

constexpr double vanishing_norm = 1e-300;
// A constant less its mean is of the order of the rounding of the constant, not of a pressure.
constexpr double vanishing_variation = 1e-13;

struct AbsoluteNorms {
    double l1, l2, linf;
};

// std::max drops a NaN in one of its two places.
double max_keeping_nan(double a, double b) {
    return b > a || std::isnan(b) ? b : a;
}

double largest_magnitude(Field field) {
    double largest = 0;
    for (const double x : field) {
        largest = max_keeping_nan(largest, std::abs(x));
    }
    return largest;
}

void check_volumes(Field volume) {
    if (volume.empty()) {
        throw std::invalid_argument("norms need at least one particle; the volume array is empty");
    }
    for (std::size_t i = 0; i < volume.size(); ++i) {
        if (!(volume[i] > 0) || !std::isfinite(volume[i])) {
            throw std::invalid_argument("norms need positive finite volumes; volume[" + std::to_string(i) +
                                        "] is " + std::to_string(volume[i]));
        }
    }
}

void check_length(Field field, Field volume, const char* name) {
    if (field.size() != volume.size()) {
        throw std::invalid_argument("norms need one entry a particle: " + std::string(name) + " has " +
                                    std::to_string(field.size()) + " entries, volume has " +
                                    std::to_string(volume.size()));
    }
}

AbsoluteNorms norms_of_magnitude(Field magnitude, Field volume) {
    const double linf = largest_magnitude(magnitude);
    if (linf == 0 || !std::isfinite(linf)) {
        return {linf, linf, linf};
    }
    double total = 0;
    double sum = 0;
    double sum_of_squares = 0;
    for (std::size_t i = 0; i < magnitude.size(); ++i) {
        const double scaled = magnitude[i] / linf; // keeps the square of a tiny or huge error representable
        total += volume[i];
        sum += volume[i] * scaled;
        sum_of_squares += volume[i] * scaled * scaled;
    }
    return {linf * (sum / total), linf * std::sqrt(sum_of_squares / total), linf};
}

Norms against(const AbsoluteNorms& error, const AbsoluteNorms& reference) {
    const bool vanishes =
        reference.l1 < vanishing_norm || reference.l2 < vanishing_norm || reference.linf < vanishing_norm;
    if (vanishes) {
        return {error.l1, error.l2, error.linf, error.l1, error.l2, error.linf, false};
    }
    return {error.l1 / reference.l1,
            error.l2 / reference.l2,
            error.linf / reference.linf,
            error.l1,
            error.l2,
            error.linf,
            true};
}

std::vector<double> difference(Field a, Field b) {
    std::vector<double> result(a.size());
    std::transform(a.begin(), a.end(), b.begin(), result.begin(), [](double x, double y) { return x - y; });
    return result;
}

std::vector<double> magnitudes(Field field) {
    std::vector<double> result(field.size());
    std::transform(field.begin(), field.end(), result.begin(), [](double x) { return std::abs(x); });
    return result;
}

// Not std::hypot: hypot(infinity, NaN) is infinity.
double euclidean_length(Field components) {
    const double largest = largest_magnitude(components);
    if (largest == 0 || !std::isfinite(largest)) {
        return largest;
    }
    double sum = 0;
    for (const double x : components) {
        sum += (x / largest) * (x / largest);
    }
    return largest * std::sqrt(sum);
}

std::vector<double> lengths(std::span<const std::vector<double>> components) {
    std::vector<double> result(components.front().size());
    std::vector<double> vector(components.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        for (std::size_t c = 0; c < components.size(); ++c) {
            vector[c] = components[c][i];
        }
        result[i] = euclidean_length(vector);
    }
    return result;
}

double volume_mean(Field value, Field volume) {
    double total = 0;
    double sum = 0;
    for (std::size_t i = 0; i < value.size(); ++i) {
        total += volume[i];
        sum += volume[i] * value[i];
    }
    return sum / total;
}

} // namespace

Norms scalar_norms(Field value, Field reference, Field volume) {
    check_volumes(volume);
    check_length(value, volume, "value");
    check_length(reference, volume, "reference");
    const auto error = magnitudes(difference(value, reference));
    return against(norms_of_magnitude(error, volume), norms_of_magnitude(magnitudes(reference), volume));
}

Norms vector_norms(std::span<const Field> value_components, std::span<const Field> reference_components,
                   Field volume) {
    check_volumes(volume);
    if (value_components.empty() || value_components.size() != reference_components.size()) {
        throw std::invalid_argument("vector norms need the same components on both sides: value has " +
                                    std::to_string(value_components.size()) + ", reference has " +
                                    std::to_string(reference_components.size()));
    }
    std::vector<std::vector<double>> errors;
    std::vector<std::vector<double>> references;
    for (std::size_t c = 0; c < value_components.size(); ++c) {
        check_length(value_components[c], volume, "a component of value");
        check_length(reference_components[c], volume, "a component of reference");
        errors.push_back(difference(value_components[c], reference_components[c]));
        references.emplace_back(reference_components[c].begin(), reference_components[c].end());
    }
    return against(norms_of_magnitude(lengths(errors), volume),
                   norms_of_magnitude(lengths(references), volume));
}

std::vector<double> mean_removed(Field value, Field volume) {
    check_volumes(volume);
    check_length(value, volume, "value");
    std::vector<double> result(value.begin(), value.end());
    // The second pass takes away what the rounding of a large mean has left.
    for (int pass = 0; pass < 2; ++pass) {
        const double mean = volume_mean(result, volume);
        for (double& x : result) {
            x -= mean;
        }
    }
    return result;
}

Norms scalar_norms_up_to_a_constant(Field value, Field reference, Field volume) {
    const auto centred_value = mean_removed(value, volume);
    auto centred_reference = mean_removed(reference, volume);
    if (largest_magnitude(centred_reference) <= vanishing_variation * largest_magnitude(reference)) {
        std::fill(centred_reference.begin(), centred_reference.end(), 0.0);
    }
    return scalar_norms(centred_value, centred_reference, volume);
}

} // namespace sphvv::verification
