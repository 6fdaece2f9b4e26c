#pragma once
// A preconditioner for A + D C D^T, from one for A.
//
// Few directions of C D^T p matter: a structure gives way in its lowest modes and hardly in any other. With W = D times those
// (AddedTerm::leading), A + W W^T has the inverse (Woodbury)
//
//   M - Z S^-1 Z^T,   Z = M W,   S = 1 + W^T Z,
//
// if M is that of A; if it is only near it, then this is as near, symmetric and positive as M is. It costs one M for each
// direction and system, and a product with D^T for each residual.

#include "kernels/preconditioner.hpp"

namespace greenwater {

/// Without a term in the system it is `inner` itself: no launch more, no memory.
std::unique_ptr<Preconditioner> make_preconditioner_with_term(std::unique_ptr<Preconditioner> inner);

}  // namespace greenwater
