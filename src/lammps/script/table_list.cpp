#include "lammps/script/table_list.hpp"

#include <algorithm>

namespace elamin::script {

int TableList::runs() const { return std::max(1, world.run_number()); }

void TableList::put(int run, Table t) {
  const auto same = std::find_if(tables.begin(), tables.end(), [&](const Table& o) {
    return o.kind == t.kind && o.serial == t.serial && o.body == t.body && o.where == t.where && o.comment == t.comment;
  });
  Table& table = same == tables.end() ? tables.emplace_back(std::move(t)) : *same;
  table.in_run.resize(static_cast<std::size_t>(runs()));
  table.in_run[run] = true;
}

void TableList::note(const Where& w, const std::string& text) {
  for (const Note& n : notes)
    if (n.text == text && n.where == w) return;
  notes.push_back({w, text});
}

void TableList::refuse(const Where& w, const std::string& key, const std::string& what) const {
  throw InputError({Mistake{reading.files[w.file], w.line, 1, key, what}});
}

}  // namespace elamin::script
