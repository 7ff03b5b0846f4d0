#include "sphvv/verification/provenance.hpp"

#include <Eigen/Core>
#include <gsl/gsl_version.h>
#include <hdf5.h>
#include <omp.h>

#include "sphvv_revision.hpp"
#include <chrono>
#include <ctime>
#include <fstream>

namespace sphvv::verification {
namespace {

std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        if (line.starts_with("model name")) {
            return line.substr(line.find(':') + 2);
        }
    }
    return "unknown";
}

std::string now() {
    const std::time_t time = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm utc{};
    gmtime_r(&time, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

} // namespace

Provenance current_provenance() {
    return {
        .version = SPHVV_VERSION,
        .revision = SPHVV_REVISION,
        .tree_clean = SPHVV_TREE_CLEAN,
        .compiler = SPHVV_COMPILER,
        .flags = SPHVV_FLAGS,
        .build_type = SPHVV_BUILD_TYPE,
        .cpu = processor(),
        .threads = omp_get_max_threads(),
        .libraries = {{"Eigen", std::to_string(EIGEN_WORLD_VERSION) + "." +
                                    std::to_string(EIGEN_MAJOR_VERSION) + "." +
                                    std::to_string(EIGEN_MINOR_VERSION)},
                      {"GSL", GSL_VERSION},
                      {"HDF5", std::to_string(H5_VERS_MAJOR) + "." + std::to_string(H5_VERS_MINOR) + "." +
                                   std::to_string(H5_VERS_RELEASE)}},
        .started = now(),
    };
}

} // namespace sphvv::verification
