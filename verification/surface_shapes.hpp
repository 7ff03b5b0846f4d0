#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sphvv::verification {

/// A box; lengths in particle spacings.
template <int Dim>
struct ShapeWindow {
    std::array<double, Dim> low;
    std::array<double, Dim> high;
};

/// A shape of fluid with its exact surface, on which detectors of the free surface are compared. Lengths are
/// in particle spacings; the cells of an aligned lattice have their faces at whole numbers. One file in
/// verification/surface_shapes/ defines one, for one or several sizes.
struct SurfaceShape {
    std::string_view name;
    std::string_view summary;
    std::string_view formula; ///< of the depth
    std::string_view size;    ///< what the size is, with its unit; empty if there is only one
    std::vector<double> sizes_2d{};
    std::vector<double> sizes_3d{};

    /// Signed distance to the surface, positive inside.
    double (*depth2)(const std::array<double, 2>&, double size) = nullptr;
    double (*depth3)(const std::array<double, 3>&, double size) = nullptr;
    /// Where particles are judged; the shape goes on beyond, unless it ends inside.
    ShapeWindow<2> (*window2)(double size) = nullptr;
    ShapeWindow<3> (*window3)(double size) = nullptr;
    /// Where the particle that an arrangement has at a place belongs in the shape (a cut whose sides are
    /// moved apart); null: at that place.
    std::array<double, 2> (*moved2)(const std::array<double, 2>&, double size) = nullptr;
    std::array<double, 3> (*moved3)(const std::array<double, 3>&, double size) = nullptr;
    /// The shape's own particles, each of whose cells is open to a side; null: those of an arrangement.
    std::vector<std::array<double, 2>> (*placed2)(double size, std::uint64_t seed) = nullptr;
    std::vector<std::array<double, 3>> (*placed3)(double size, std::uint64_t seed) = nullptr;

    template <int Dim>
    const std::vector<double>& sizes() const {
        return Dim == 2 ? sizes_2d : sizes_3d;
    }
    template <int Dim>
    double depth(const std::array<double, Dim>& x, double at_size) const {
        if constexpr (Dim == 2) {
            return depth2(x, at_size);
        } else {
            return depth3(x, at_size);
        }
    }
    template <int Dim>
    ShapeWindow<Dim> window(double at_size) const {
        if constexpr (Dim == 2) {
            return window2(at_size);
        } else {
            return window3(at_size);
        }
    }
    template <int Dim>
    std::array<double, Dim> moved(const std::array<double, Dim>& x, double at_size) const {
        if constexpr (Dim == 2) {
            return moved2 == nullptr ? x : moved2(x, at_size);
        } else {
            return moved3 == nullptr ? x : moved3(x, at_size);
        }
    }
    template <int Dim>
    std::vector<std::array<double, Dim>> placed(double at_size, std::uint64_t seed) const {
        if constexpr (Dim == 2) {
            return placed2(at_size, seed);
        } else {
            return placed3(at_size, seed);
        }
    }
    bool is_placed() const { return placed2 != nullptr; }
    /// "wedge 15 degrees", "disc".
    std::string title(double at_size) const;
};

/// Completes a declaration with the geometry, a type with
///   template <int Dim> static double depth(const std::array<double, Dim>&, double size)
///   template <int Dim> static ShapeWindow<Dim> window(double size)
/// and, where the declaration's comments say so, `moved` of the depth's form that gives a place.
template <class Geometry>
SurfaceShape with_geometry(SurfaceShape declaration) {
    declaration.depth2 = Geometry::template depth<2>;
    declaration.depth3 = Geometry::template depth<3>;
    declaration.window2 = Geometry::template window<2>;
    declaration.window3 = Geometry::template window<3>;
    if constexpr (requires { Geometry::template moved<2>; }) {
        declaration.moved2 = Geometry::template moved<2>;
        declaration.moved3 = Geometry::template moved<3>;
    }
    return declaration;
}

/// The same for a shape that places its particles, a type with
///   template <int Dim> static std::vector<std::array<double, Dim>> placed(double size, std::uint64_t seed).
template <class Geometry>
SurfaceShape with_particles(SurfaceShape declaration) {
    declaration.placed2 = Geometry::template placed<2>;
    declaration.placed3 = Geometry::template placed<3>;
    return declaration;
}

namespace surface_shapes {
/// Every shape in verification/surface_shapes/, in the order of the file names.
std::span<const SurfaceShape* const> all();
/// The shape of that name. Throws UserError naming the accepted ones.
const SurfaceShape& find(std::string_view name);
} // namespace surface_shapes

} // namespace sphvv::verification
