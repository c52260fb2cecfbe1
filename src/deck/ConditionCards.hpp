#pragma once

/// What is prescribed: supports, forces, loads, temperatures, equations, and the axes and times of these.

#include "epafi/deck/Reading.hpp"

namespace epafi::deck {

void readBoundary(Reading& reading, const Card& card);    ///< in a step or before
void readNodeForce(Reading& reading, const Card& card);   ///< *CLOAD
void readElementLoad(Reading& reading, const Card& card); ///< *DLOAD
void readSurfaceLoad(Reading& reading, const Card& card); ///< *DSLOAD
void readTemperature(Reading& reading, const Card& card);
void readInitialConditions(Reading& reading, const Card& card);

void readEquation(Reading& reading, const Card& card);
/// Whether elements of a type are no solids, but nodes that stand for others.
bool isCoupling(const std::string& elementType);
void readCoupling(Reading& reading, const Card& card);
void readDistributing(Reading& reading, const Card& card);
void readDistributingCoupling(Reading& reading, const Card& card);
void readTransform(Reading& reading, const Card& card);
void readAmplitude(Reading& reading, const Card& card);

} // namespace epafi::deck
