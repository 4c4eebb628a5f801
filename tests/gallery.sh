#!/usr/bin/env bash
# tests/gallery.sh - renders every glTF file below a folder and writes one HTML page to look at.
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail

usage() {
    cat <<'TEXT'
usage: tests/gallery.sh [options] DIR [OUT]

Renders each .gltf and .glb below DIR, ordered by name, and writes OUT/index.html (default OUT:
gallery): per file a thumbnail, the wall time, the exit code, the warnings and the RESULT line. The
page holds its pictures; OUT also keeps each picture and each log under the file's number.

  --env FILE     light every scene with this environment (.hdr, .exr)
  --size WxH     picture size (320x240)
  --spp N        samples per pixel (16)
  --limit SEC    seconds before a render counts as hung (60)
  --obscura BIN  the program (build/release/bin/obscura beside this script)

Exit code: 0 all rendered or were refused with a reason, 1 something crashed or hung, 64 usage.
TEXT
}

refuse() {
    printf 'gallery.sh: %s\n' "$*" >&2
    usage >&2
    exit 64
}

obscura="$(dirname -- "${BASH_SOURCE[0]}")/../build/release/bin/obscura"
size=320x240
spp=16
limit=60
extra=()
folders=()
while (($# > 0)); do
    case "$1" in
        -h | --help)
            usage
            exit 0
            ;;
        --env | --size | --spp | --limit | --obscura)
            (($# > 1)) || refuse "$1 needs a value"
            case "$1" in
                --env) extra=(--env "$2") ;;
                --size) size="$2" ;;
                --spp) spp="$2" ;;
                --limit) limit="$2" ;;
                --obscura) obscura="$2" ;;
            esac
            shift
            ;;
        --)
            shift
            folders+=("$@")
            break
            ;;
        -*) refuse "unknown option $1" ;;
        *) folders+=("$1") ;;
    esac
    shift
done
((${#folders[@]} == 1 || ${#folders[@]} == 2)) || refuse "give a folder of models"
# An absolute name never looks like an option.
models="$(realpath -- "${folders[0]}")"
[[ -d "$models" ]] || refuse "${folders[0]} is not a folder"
[[ -x "$obscura" ]] || refuse "$obscura is not there: build it with ./run.sh, or give --obscura"
mkdir -p -- "${folders[1]:-gallery}"
out="$(realpath -- "${folders[1]:-gallery}")"

mapfile -d '' files < <(find "$models" -type f \( -iname '*.gltf' -o -iname '*.glb' \) -print0 |
    LC_ALL=C sort -z)
((${#files[@]} > 0)) || refuse "there is no .gltf or .glb below ${folders[0]}"

escape_html() { sed -e 's/&/\&amp;/g' -e 's/</\&lt;/g' -e 's/>/\&gt;/g' -e 's/"/\&quot;/g'; }

# outcome_of CODE MILLISECONDS - rendered, refused, crashed or hung.
outcome_of() {
    case "$1" in
        0) echo rendered ;;
        124) echo hung ;;
        137) if (($2 >= limit * 1000)); then echo hung; else echo crashed; fi ;;
        70 | 1[2-9][0-9] | 2[0-9][0-9]) echo crashed ;;
        *) echo refused ;;
    esac
}

page_begin() {
    cat <<'TEXT'
<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Obscura gallery</title>
<style>
body { font: 14px/1.4 sans-serif; margin: 1.5em; background: #f4f4f4; color: #222; }
.models { display: flex; flex-wrap: wrap; gap: 12px; }
.model { width: 322px; background: #fff; border: 1px solid #ccc; padding: 8px; }
.model.crashed, .model.hung { border-color: #c00; background: #fff0f0; }
.model.refused { background: #fffbe8; }
.model img, .model .none { width: 320px; height: 240px; object-fit: contain; background: #ddd; }
.name { font-weight: bold; overflow-wrap: anywhere; margin: 4px 0; }
pre { font-size: 11px; white-space: pre-wrap; overflow-wrap: anywhere; margin: 4px 0; }
</style></head><body>
TEXT
}

# page_model NUMBER NAME OUTCOME CODE SECONDS - one card, from the picture and log of that number.
page_model() {
    local number="$1" name="$2" outcome="$3" code="$4" seconds="$5"
    printf '<div class="model %s">' "$outcome"
    if [[ -s "$out/$number.png" ]]; then
        printf '<img alt="" src="data:image/png;base64,'
        base64 -w 0 -- "$out/$number.png"
        printf '">'
    else
        printf '<div class="none"></div>'
    fi
    printf '<p class="name">%s</p>' "$(printf '%s' "$name" | escape_html)"
    printf '<p>%s, exit code %s, %s s</p><pre>' "$outcome" "$code" "$seconds"
    sed -n -e '/^WARN /p' -e '/^ERROR /p' -e '/^RESULT /p' -e '/Sanitizer/p' "$out/$number.log" |
        escape_html
    printf '</pre></div>\n'
}

declare -A count=([rendered]=0 [refused]=0 [crashed]=0 [hung]=0) refused_with=()
bad=()
cards="$out/cards.part"
: >"$cards"
for i in "${!files[@]}"; do
    file="${files[$i]}"
    number="$(printf '%04d' "$((i + 1))")"
    name="${file#"$models"/}"
    rm -f -- "$out/$number.png" "$out/$number.log"
    begin="$(date +%s%N)"
    code=0
    timeout -k 5 "$limit" "$obscura" render "$file" --size "$size" --spp "$spp" "${extra[@]}" \
        -o "$out/$number.png" </dev/null >/dev/null 2>"$out/$number.log" || code=$?
    milliseconds="$((($(date +%s%N) - begin) / 1000000))"
    seconds="$((milliseconds / 1000)).$(printf '%03d' "$((milliseconds % 1000))")"
    outcome="$(outcome_of "$code" "$milliseconds")"
    count[$outcome]=$((count[$outcome] + 1))
    case "$outcome" in
        refused) refused_with[$code]=$((${refused_with[$code]:-0} + 1)) ;;
        crashed | hung) bad+=("$outcome with $code: $name") ;;
    esac
    page_model "$number" "$name" "$outcome" "$code" "$seconds" >>"$cards"
    printf '%-8s %3d %8s s  %s\n' "$outcome" "$code" "$seconds" "$name"
done

summary="${#files[@]} files: ${count[rendered]} rendered, ${count[refused]} refused"
codes=''
while read -r code; do
    [[ -z "$code" ]] || codes+="${codes:+, }${refused_with[$code]} with code $code"
done < <(printf '%s\n' "${!refused_with[@]}" | sort -n)
[[ -z "$codes" ]] || summary+=" ($codes)"
summary+=", ${count[crashed]} crashed, ${count[hung]} hung"

{
    page_begin
    printf '<h1>Obscura gallery</h1>\n<p>%s; %s, %s samples per pixel</p>\n<div class="models">\n' \
        "$summary" "$size" "$spp"
    cat -- "$cards"
    printf '</div></body></html>\n'
} >"$out/index.html"
rm -f -- "$cards"

printf '\n%s\n%s\n' "$summary" "$out/index.html"
if ((${#bad[@]} > 0)); then
    printf '%s\n' "${bad[@]}"
    exit 1
fi
