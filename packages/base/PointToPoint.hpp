#pragma once

/// Messages between pairs of ranks.

#include "epafi/base/Types.hpp"

#include <map>
#include <set>
#include <vector>

namespace epafi {

/// Sends `outgoing`, one message a rank, and returns what the ranks in `senders` send here. Every rank named there must
/// send, and to no other rank may anyone send; a message may be empty. Collective only in that all partners call it.
std::map<int, std::vector<double>> exchangeMessages(const Comm& comm,
                                                    const std::map<int, std::vector<double>>& outgoing,
                                                    const std::set<int>& senders);

} // namespace epafi
