#include "io/case_node.hpp"

#include <algorithm>

namespace greenwater {

CaseNode* CaseNode::child(std::string_view name) {
  const auto found = std::find_if(children.begin(), children.end(), [&](const CaseNode& n) { return n.key == name; });
  return found == children.end() ? nullptr : &*found;
}

const CaseNode* CaseNode::child(std::string_view name) const { return const_cast<CaseNode*>(this)->child(name); }

std::string_view kind_name(CaseNode::Kind kind) {
  switch (kind) {
    case CaseNode::Kind::table: return "a table";
    case CaseNode::Kind::list: return "a list";
    case CaseNode::Kind::text: return "a text";
    case CaseNode::Kind::whole: return "a whole number";
    case CaseNode::Kind::real: return "a number";
    case CaseNode::Kind::flag: return "true or false";
    case CaseNode::Kind::date: return "a date or time";
  }
  return "something else";
}

}  // namespace greenwater
