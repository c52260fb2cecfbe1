#include "epafi/base/PointToPoint.hpp"

#include <Teuchos_CommHelpers.hpp>

namespace epafi {
namespace {

constexpr int lengthTag = 7301, valuesTag = 7302;

using Request = RCP<Teuchos::CommRequest<int>>;
using Buffers = std::map<int, Teuchos::ArrayRCP<double>>;

/// Sends and receives buffers whose lengths both partners know.
void exchangeBuffers(const Comm& comm, const Buffers& outgoing, const Buffers& incoming, int tag) {
  std::vector<Request> requests;
  for (const auto& [rank, buffer] : incoming)
    requests.push_back(Teuchos::ireceive(buffer, rank, tag, comm));
  for (const auto& [rank, buffer] : outgoing)
    requests.push_back(Teuchos::isend(
        Teuchos::arcp_const_cast<const double>(Teuchos::arcp_implicit_cast<const double>(buffer)), rank, tag,
        comm));
  Teuchos::waitAll(comm, Teuchos::arrayViewFromVector(requests));
}

} // namespace

std::map<int, std::vector<double>> exchangeMessages(const Comm& comm,
                                                    const std::map<int, std::vector<double>>& outgoing,
                                                    const std::set<int>& senders) {
  Buffers lengths, values, lengthsHere, valuesHere;
  for (const auto& [rank, message] : outgoing) {
    lengths[rank] = Teuchos::arcp<double>(1);
    lengths[rank][0] = static_cast<double>(message.size());
    if (!message.empty()) {
      values[rank] = Teuchos::arcp<double>(static_cast<Teuchos_Ordinal>(message.size()));
      std::copy(message.begin(), message.end(), values[rank].begin());
    }
  }
  for (const int rank : senders)
    lengthsHere[rank] = Teuchos::arcp<double>(1);
  exchangeBuffers(comm, lengths, lengthsHere, lengthTag);
  for (const auto& [rank, length] : lengthsHere)
    if (length[0] > 0)
      valuesHere[rank] = Teuchos::arcp<double>(static_cast<Teuchos_Ordinal>(length[0]));
  exchangeBuffers(comm, values, valuesHere, valuesTag);
  std::map<int, std::vector<double>> result;
  for (const int rank : senders) {
    result[rank];
    if (const auto found = valuesHere.find(rank); found != valuesHere.end())
      result[rank].assign(found->second.begin(), found->second.end());
  }
  return result;
}

} // namespace epafi
