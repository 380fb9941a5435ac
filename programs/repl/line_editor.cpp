#include "programs/repl/line_editor.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#ifdef ABBE_HAS_LIBEDIT
#include <histedit.h>
#endif

namespace abbe {

namespace {

bool part_of_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '(' || c == ')';
}

bool begins_with(const std::string& word, const std::string& beginning) {
  return word.size() >= beginning.size() &&
      std::equal(beginning.begin(), beginning.end(), word.begin(),
                 [](unsigned char a, unsigned char b) { return std::toupper(a) == std::toupper(b); });
}

/// The word that is being typed. A name inside `FA(` begins behind the parenthesis; the operand of a command is a path.
std::string last_word(const std::string& line, bool inside_parenthesis) {
  if (line.starts_with('.')) return line.substr(line.find_last_of(" /") + 1);
  std::size_t begin = line.size();
  while (begin > 0 && part_of_word(line[begin - 1]) && !(inside_parenthesis && line[begin - 1] == '(')) --begin;
  return line.substr(begin);
}

}  // namespace

std::string completion_of(const std::string& line, const std::vector<std::string>& words) {
  for (const bool inside : {false, true}) {
    const std::string typed = last_word(line, inside);
    std::optional<std::string> common;
    for (const std::string& word : words) {
      if (!begins_with(word, typed)) continue;
      if (!common) common = word;
      const auto differ = std::mismatch(common->begin(), common->end(), word.begin(), word.end());
      common->erase(differ.first, common->end());
    }
    if (common && common->size() > typed.size()) return common->substr(typed.size());
  }
  return "";
}

#ifdef ABBE_HAS_LIBEDIT

struct LineEditor::Terminal {
  explicit Terminal(Completer complete_) : complete(std::move(complete_)) {
    edit = el_init("abbe", stdin, stdout, stderr);
    past = history_init();
    HistEvent event;
    history(past, &event, H_SETSIZE, 1000);
    history(past, &event, H_SETUNIQUE, 1);
    el_set(edit, EL_CLIENTDATA, this);
    el_set(edit, EL_PROMPT, &Terminal::show_prompt);
    el_set(edit, EL_EDITOR, "emacs");
    el_set(edit, EL_HIST, history, past);
    el_set(edit, EL_ADDFN, "abbe-complete", "complete the word", &Terminal::complete_word);
    el_set(edit, EL_BIND, "^I", "abbe-complete", nullptr);
    // While a line is typed ^C drops its entry and not the session; while figures are computed it ends the
    // program as ever.
    el_set(edit, EL_SETTY, "-d", "-isig", nullptr);
    el_set(edit, EL_ADDFN, "abbe-drop", "drop the entry", &Terminal::drop_entry);
    el_set(edit, EL_BIND, "^C", "abbe-drop", nullptr);
    el_set(edit, EL_SIGNAL, 1);
  }
  ~Terminal() {
    history_end(past);
    el_end(edit);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  static Terminal& of(EditLine* edit) {
    void* data = nullptr;
    el_get(edit, EL_CLIENTDATA, &data);
    return *static_cast<Terminal*>(data);
  }
  static char* show_prompt(EditLine* edit) { return of(edit).prompt.data(); }

  static unsigned char complete_word(EditLine* edit, int) {
    const LineInfo* info = el_line(edit);
    const std::string line(info->buffer, info->cursor);
    const std::vector<std::string> words = of(edit).complete(line);
    const std::string added = completion_of(line, words);
    if (!added.empty()) return el_insertstr(edit, added.c_str()) == 0 ? CC_REFRESH : CC_ERROR;
    return show_choice(line, words) ? CC_REDISPLAY : CC_ERROR;
  }

  static unsigned char drop_entry(EditLine* edit, int) {
    std::fputs("^C\n", stdout);
    of(edit).dropped = true;
    return CC_NEWLINE;
  }

  /// The words among which the person has to choose, below the line. False when there are none.
  static bool show_choice(const std::string& line, const std::vector<std::string>& words) {
    constexpr int kShown = 60;
    int shown = 0;
    for (const std::string& word : words) {
      if (!begins_with(word, last_word(line, false)) && !begins_with(word, last_word(line, true))) continue;
      if (shown == kShown) std::fputs(" ...", stdout);
      if (++shown <= kShown) std::fprintf(stdout, "%s%s", shown == 1 ? "\n" : " ", word.c_str());
    }
    if (shown > 0) std::fputs("\n", stdout);
    return shown > 0;
  }

  Completer complete;
  std::string prompt;
  bool dropped = false;
  EditLine* edit = nullptr;
  History* past = nullptr;
};

#else

struct LineEditor::Terminal {};

#endif

LineEditor::LineEditor(Completer complete) : interactive_(isatty(STDIN_FILENO) == 1) {
#ifdef ABBE_HAS_LIBEDIT
  if (interactive_) terminal_ = std::make_unique<Terminal>(std::move(complete));
#else
  (void)complete;
#endif
}

LineEditor::~LineEditor() = default;

std::optional<std::string> LineEditor::read_plainly(const std::string& prompt) {
  if (interactive_) {
    std::fputs(prompt.c_str(), stdout);
    std::fflush(stdout);
  }
  std::string line;
  int c = std::fgetc(stdin);
  if (c == EOF) return std::nullopt;
  for (; c != EOF && c != '\n'; c = std::fgetc(stdin)) line += static_cast<char>(c);
  return line;
}

std::optional<LineEditor::Line> LineEditor::read(const std::string& prompt) {
#ifdef ABBE_HAS_LIBEDIT
  if (terminal_) {
    terminal_->prompt = prompt;
    int length = 0;
    const char* text = el_gets(terminal_->edit, &length);
    if (std::exchange(terminal_->dropped, false)) return Line{"", true};
    if (!text || length <= 0) return std::nullopt;
    std::string line(text, static_cast<std::size_t>(length));
    while (line.ends_with('\n') || line.ends_with('\r')) line.pop_back();
    HistEvent event;
    if (!line.empty()) history(terminal_->past, &event, H_ENTER, line.c_str());
    return Line{std::move(line)};
  }
#endif
  std::optional<std::string> line = read_plainly(prompt);
  if (!line) return std::nullopt;
  if (line->ends_with('\r')) line->pop_back();
  return Line{std::move(*line)};
}

}  // namespace abbe
