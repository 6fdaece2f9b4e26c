#include "app/formula.hpp"

#include <muParser.h>

#include <cctype>
#include <numbers>
#include <string_view>

namespace greenwater {
namespace {

/// muParser takes `x = 3` as an assignment to x. Returns the place of such a sign, or npos.
std::size_t find_assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool doubled = i + 1 < text.size() && text[i + 1] == '=';
    const bool compares = i > 0 && (text[i - 1] == '<' || text[i - 1] == '>' || text[i - 1] == '!');
    if (!doubled && !compares) return i;
    if (doubled) ++i;
  }
  return std::string::npos;
}

bool in_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Where a name stands as a word of its own.
std::size_t find_name(const std::string& text, const std::string& name) {
  for (std::size_t i = text.find(name); i != std::string::npos; i = text.find(name, i + 1)) {
    const std::size_t end = i + name.size();
    if ((i == 0 || !in_name(text[i - 1])) && (end == text.size() || !in_name(text[end]))) return i;
  }
  return 0;
}

std::string_view known_to(Variables variables) {
  switch (variables) {
    case Variables::place_and_time: return "variables are x, y, z [m] and t [s]";
    case Variables::time: return "the only variable is t [s]";
    case Variables::place_time_velocity: return "variables are x, y, z [m], t [s] and the velocity u, v, w [m/s]";
  }
  return {};
}

bool allows(Variables variables, const std::string& name) {
  if (name == "t") return true;
  const bool place = name == "x" || name == "y" || name == "z";
  return variables == Variables::place_time_velocity || (place && variables == Variables::place_and_time);
}

struct Source {
  const std::string& text;
  const Place& place;
  Variables variables;
};

[[noreturn]] void refuse_formula(const Source& source, std::size_t position, const std::string& why) {
  const std::size_t shown = std::min(position, source.text.size());
  refuse(source.place, "formula \"", source.text, "\", character ", shown + 1, ": ", why, "; ",
         known_to(source.variables), ", constants pi and e");
}

}  // namespace

// It knows all variables; which of them are allowed is asked afterwards, for the sake of a better complaint.
struct Formula::Engine {
  mu::Parser parser;
  double x = 0, y = 0, z = 0, t = 0, u = 0, v = 0, w = 0;

  explicit Engine(const std::string& text) {
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    parser.DefineVar("z", &z);
    parser.DefineVar("t", &t);
    parser.DefineVar("u", &u);
    parser.DefineVar("v", &v);
    parser.DefineVar("w", &w);
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineConst("e", std::numbers::e);
    parser.SetExpr(text);
  }
};

Formula::Formula(const std::string& text, const Place& place, Variables variables) {
  const Source source{text, place, variables};
  const std::size_t assignment = find_assignment(text);
  if (assignment != std::string::npos) refuse_formula(source, assignment, "\"=\" has no meaning here (equality is ==)");
  try {
    engine_ = std::make_unique<Engine>(text);
    engine_->parser.Eval();
  } catch (const mu::Parser::exception_type& fault) {
    const auto position = fault.GetPos();
    std::string why = fault.GetMsg();
    while (!why.empty() && (why.back() == '.' || std::isspace(static_cast<unsigned char>(why.back())) != 0))
      why.pop_back();
    refuse_formula(source, position < 0 ? text.size() : static_cast<std::size_t>(position), why);
  }
  if (engine_->parser.GetNumResults() != 1) refuse_formula(source, 0, "one value is wanted, not a list");
  for (const auto& [name, where] : engine_->parser.GetUsedVar()) {
    if (!allows(variables, name)) refuse_formula(source, find_name(text, name), '"' + name + "\" has no meaning here");
  }
}

Formula::~Formula() = default;
Formula::Formula(Formula&&) noexcept = default;
Formula& Formula::operator=(Formula&&) noexcept = default;

double Formula::operator()(double x, double y, double z, double t, const std::array<double, 3>& u) const {
  engine_->x = x;
  engine_->y = y;
  engine_->z = z;
  engine_->t = t;
  engine_->u = u[0];
  engine_->v = u[1];
  engine_->w = u[2];
  return engine_->parser.Eval();
}

bool Formula::constant() const { return engine_->parser.GetUsedVar().empty(); }

bool Formula::varies_in_time() const { return engine_->parser.GetUsedVar().contains("t"); }

std::array<Formula, 3> compile(const std::array<std::string, 3>& text, const Place& place, Variables variables) {
  return {Formula(text[0], place, variables), Formula(text[1], place, variables), Formula(text[2], place, variables)};
}

bool is_zero(const std::array<Formula, 3>& formulas) {
  for (const Formula& formula : formulas) {
    if (!formula.constant() || formula(0, 0, 0, 0) != 0) return false;
  }
  return true;
}

}  // namespace greenwater
