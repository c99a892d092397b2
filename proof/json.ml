(* SPDX-License-Identifier: Apache-2.0 *)
(* One line of JSON, as strict as docs/cpp/certificates.md asks for. *)
exception Malformed of string

type t =
  | Null
  | Bool of bool
  | Whole of Z.t  (* a number without point and exponent, and not -0 *)
  | Other_number of float
  | String of string
  | List of t list
  | Object of (string * t) list

let deepest = 4
let fail what = raise (Malformed what)

let utf8 buffer code =
  let add n = Buffer.add_char buffer (Char.chr n) in
  let tail shift = add (0x80 lor ((code lsr shift) land 0x3f)) in
  if code < 0x80 then add code
  else if code < 0x800 then (add (0xc0 lor (code lsr 6)); tail 0)
  else if code < 0x10000 then (add (0xe0 lor (code lsr 12)); tail 6; tail 0)
  else (add (0xf0 lor (code lsr 18)); tail 12; tail 6; tail 0)

let parse text =
  let size = String.length text in
  let at = ref 0 in
  let peek () = if !at < size then text.[!at] else '\000' in
  let next () = if !at >= size then fail "the line ends early" else (incr at; text.[!at - 1]) in
  let byte () = Char.code (next ()) in
  let rec blanks () = match peek () with ' ' | '\t' | '\r' | '\n' when !at < size -> incr at; blanks () | _ -> () in
  let expect word = String.iter (fun c -> if next () <> c then fail "an unknown word") word in
  let hex4 () =
    let digit () = match next () with
      | '0' .. '9' as c -> Char.code c - 48
      | 'a' .. 'f' as c -> Char.code c - 87
      | 'A' .. 'F' as c -> Char.code c - 55
      | _ -> fail "no hexadecimal digit" in
    let a = digit () in let b = digit () in let c = digit () in let d = digit () in
    (a lsl 12) lor (b lsl 8) lor (c lsl 4) lor d in
  let escape buffer = match next () with
    | ('"' | '\\' | '/') as c -> Buffer.add_char buffer c
    | 'b' -> Buffer.add_char buffer '\b'
    | 'f' -> Buffer.add_char buffer '\012'
    | 'n' -> Buffer.add_char buffer '\n'
    | 'r' -> Buffer.add_char buffer '\r'
    | 't' -> Buffer.add_char buffer '\t'
    | 'u' ->
      let code = hex4 () in
      if code >= 0xdc00 && code <= 0xdfff then fail "half of a surrogate pair";
      if code >= 0xd800 && code <= 0xdbff then begin
        if next () <> '\\' || next () <> 'u' then fail "half of a surrogate pair";
        let low = hex4 () in
        if low < 0xdc00 || low > 0xdfff then fail "half of a surrogate pair";
        utf8 buffer (0x10000 + ((code - 0xd800) lsl 10) + (low - 0xdc00))
      end else utf8 buffer code
    | _ -> fail "an unknown escape" in
  (* A byte from 0x80 begins a letter of UTF-8; the shortest form only, and no surrogates. *)
  let letter buffer first =
    let start = !at - 1 in
    let tail low high = let b = byte () in if b < low || b > high then fail "no UTF-8" in
    (match first with
     | _ when first >= 0xc2 && first <= 0xdf -> tail 0x80 0xbf
     | 0xe0 -> tail 0xa0 0xbf; tail 0x80 0xbf
     | 0xed -> tail 0x80 0x9f; tail 0x80 0xbf
     | _ when first >= 0xe1 && first <= 0xef -> tail 0x80 0xbf; tail 0x80 0xbf
     | 0xf0 -> tail 0x90 0xbf; tail 0x80 0xbf; tail 0x80 0xbf
     | 0xf4 -> tail 0x80 0x8f; tail 0x80 0xbf; tail 0x80 0xbf
     | _ when first >= 0xf1 && first <= 0xf3 -> tail 0x80 0xbf; tail 0x80 0xbf; tail 0x80 0xbf
     | _ -> fail "no UTF-8");
    Buffer.add_substring buffer text start (!at - start) in
  let rec string buffer = match byte () with
    | 0x22 -> Buffer.contents buffer
    | 0x5c -> escape buffer; string buffer
    | c when c < 0x20 -> fail "a control character"
    | c when c < 0x80 -> Buffer.add_char buffer (Char.chr c); string buffer
    | c -> letter buffer c; string buffer in
  let number () =
    let start = !at in
    let digits () =
      let first = !at in
      while (match peek () with '0' .. '9' -> true | _ -> false) do incr at done;
      if !at = first then fail "no digit" in
    if peek () = '-' then incr at;
    if peek () = '0' then incr at else digits ();
    let whole = match peek () with '.' | 'e' | 'E' -> false | _ -> true in
    if peek () = '.' then (incr at; digits ());
    (match peek () with
     | 'e' | 'E' -> incr at; (match peek () with '+' | '-' -> incr at | _ -> ()); digits ()
     | _ -> ());
    let word = String.sub text start (!at - start) in
    let nearest = float_of_string word in
    if not (Float.is_finite nearest) then fail "a number that no double can hold";
    if whole && word <> "-0" then Whole (Z.of_string word) else Other_number nearest in
  let rec value depth =
    if depth > deepest then fail "too deep";
    blanks ();
    match peek () with
    | 'n' -> expect "null"; Null
    | 't' -> expect "true"; Bool true
    | 'f' -> expect "false"; Bool false
    | '"' -> incr at; String (string (Buffer.create 16))
    | '[' -> incr at; List (items depth ']' (fun () -> value (depth + 1)))
    | '{' -> incr at; Object (items depth '}' (fun () -> pair depth))
    | _ -> number ()
  and pair depth =
    blanks ();
    if next () <> '"' then fail "no key";
    let key = string (Buffer.create 16) in
    blanks ();
    if next () <> ':' then fail "no colon";
    (key, value (depth + 1))
  and items : 'a. int -> char -> (unit -> 'a) -> 'a list = fun _ last item ->
    blanks ();
    if peek () = last then (incr at; [])
    else
      let rec more taken =
        let taken = item () :: taken in
        blanks ();
        match next () with
        | ',' -> more taken
        | c when c = last -> List.rev taken
        | _ -> fail "no comma" in
      more [] in
  let result = value 0 in
  blanks ();
  if !at < size then fail "more behind the value";
  result

(* The last of several values of one key counts. *)
let find key fields = List.fold_left (fun found (k, v) -> if k = key then Some v else found) None fields
