# What zsh completes: for each LINE as typed before Tab, the matches, one "LINE<tab>MATCH" each.
#
#     zsh -f zsh_completion.zsh DIRECTORY_OF_THE_COMPLETION LINE...
#
# An interactive shell in a pseudo-terminal completes the lines; in it every compadd prints what it adds.

zmodload zsh/zpty

# Calls that fill arrays (-O, -A, -D) add no matches.
compadd() {
  if [[ -n ${(M)@[1,(i)(-|--)]:#-[OAD]*} ]]; then builtin compadd "$@"; return; fi
  local -a matches
  builtin compadd -A matches "$@"
  print -rl -- "match:"$^matches
  builtin compadd "$@"
}

print_matches() {
  print -r -- "begin:"
  _main_complete
  compstate[insert]= compstate[list]=
  print -r -- "end:"
}

local text
zpty shell zsh -f -i
zpty -w shell "PROMPT=; stty -echo; $(functions compadd print_matches)
  fpath=(${(qq)1} \$fpath); autoload -Uz compinit; compinit -D -u
  zle -C print_matches complete-word print_matches; bindkey '^I' print_matches; bindkey '^U' kill-whole-line
  print -r -- 're''ady:'"
zpty -r -m shell text '*ready:*' || exit 1
shift

local line
for line; do
  zpty -w -n shell $'\C-u'"$line"$'\t'
  zpty -r -m shell text '*end:*' || exit 1
  print -rl -- "$line"$'\t'${^${(M)${(f)${${text##*begin:}//$'\r'/}}:#match:*}#match:}
done
zpty -d shell
