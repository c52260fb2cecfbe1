#include "epafi/deck/StepCards.hpp"

#include "epafi/base/Errors.hpp"

namespace epafi::deck {
void readHeading(Reading& reading, const Card& card) {
  if (reading.deck.title.empty() && !card.data.empty())
    reading.deck.title = card.data[0].text;
}

void readStep(Reading& reading, const Card& card) {
  if (reading.isInStep)
    card.refuse("the step of " + text(reading.step().place) +
                " has not ended; put *END STEP before this one");
  const std::string nonlinear = card.value("NLGEOM");
  if (card.has("NLGEOM"))
    reading.isNonlinear = nonlinear != "NO"; // and so are the steps that follow
  reading.isInStep = true;
  reading.hasProcedure = false;
  reading.deck.steps.emplace_back();
  reading.step().place = card.place;
  reading.step().isPerturbation = card.has("PERTURBATION");
  reading.step().isNonlinear = reading.isNonlinear && !card.has("PERTURBATION");
}

void readStatic(Reading& reading, const Card& card) {
  if (reading.hasProcedure)
    card.refuse("the step has one already");
  reading.hasProcedure = true;
  if (card.has("SOLVER"))
    reading.ignore(card.shown + ", SOLVER", card.place);
  if (card.data.size() > 1)
    card.refuseAt(card.data[1].place(), "it has one line, of times; take this one out");
  if (card.data.empty())
    return;
  const Fields fields(card, card.data[0]);
  for (int i = 0; i < fields.size(); ++i)
    if (fields.realOr(i, "a time", 0) < 0)
      fields.refuse("times should not be negative");
  reading.step().period = fields.realOr(1, "the step's period", 1);
  if (reading.step().period == 0)
    fields.refuse("the step's period, its second number, should be positive");
}

void readEndStep(Reading& reading, const Card& card) {
  if (!reading.hasProcedure)
    card.refuse("the step of " + text(reading.step().place) + " has no *STATIC; add it");
  if (reading.awaitsFriction)
    card.refuse("the step has a *CHANGE FRICTION without the *FRICTION that belongs behind it");
  reading.isInStep = false;
}

} // namespace epafi::deck
