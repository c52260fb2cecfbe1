#pragma once

#include "epafi/base/Types.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>

namespace epafi::test {

/// This rank alone.
inline RCP<const Comm> thisRankOnly() {
  const RCP<const Comm> all = Tpetra::getDefaultComm();
  return all->split(all->getRank(), 0);
}

} // namespace epafi::test
