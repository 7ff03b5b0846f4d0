#pragma once

#include <stdexcept>

namespace sphvv {

/// A mistake in what the user asked for: an unknown key, an impossible value, a file that cannot be used. The
/// message is one sentence that names what, where and what is accepted. The command line turns it into exit
/// status 2.
struct UserError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace sphvv
