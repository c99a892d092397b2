(* SPDX-License-Identifier: Apache-2.0 *)
(** What one cell proves of two faces: the geometry of [soundness.v]. *)
Require Import ZArith QArith Lqa Lia List Bool.
From Certificates Require Import statement checker.
Import ListNotations.
Open Scope Q_scope.

Definition rational (p : triple Z) : point := map3 inject_Z p.
Definition dotq (d p : point) : Q := x d * x p + y d * y p + z d * z p.

Lemma inject_le a b : (a <= b)%Z -> inject_Z a <= inject_Z b.
Proof. now rewrite <- Zle_Qle. Qed.
Lemma inject_lt a b : (a < b)%Z -> inject_Z a < inject_Z b.
Proof. now rewrite <- Zlt_Qlt. Qed.
Lemma inject_dot d p : inject_Z (dot d p) == dotq (rational d) (rational p).
Proof. unfold dot, dotq, rational, map3; cbn. now rewrite !inject_Z_plus, !inject_Z_mult. Qed.

(** * Weights *)

Lemma weighted_dot d ws vs :
  weighted ws (map (dotq d) vs)
  == x d * weighted ws (map x vs) + y d * weighted ws (map y vs) + z d * weighted ws (map z vs).
Proof.
  revert vs; induction ws as [| w ws IH]; intros [| v vs]; cbn; try ring.
  rewrite IH. unfold dotq. ring.
Qed.

Lemma weighted_le m ws vs : (forall w, In w ws -> 0 <= w) -> (forall v, In v vs -> v <= m) ->
  length ws = length vs -> weighted ws vs <= m * sum ws.
Proof.
  revert vs; induction ws as [| w ws IH]; intros [| v vs] Hw Hv L; cbn in *; try discriminate; [lra |].
  assert (weighted ws vs <= m * sum ws) by (apply IH; auto).
  assert (0 <= w) by auto. assert (v <= m) by auto. nra.
Qed.
Lemma weighted_ge m ws vs : (forall w, In w ws -> 0 <= w) -> (forall v, In v vs -> m <= v) ->
  length ws = length vs -> m * sum ws <= weighted ws vs.
Proof.
  revert vs; induction ws as [| w ws IH]; intros [| v vs] Hw Hv L; cbn in *; try discriminate; [lra |].
  assert (m * sum ws <= weighted ws vs) by (apply IH; auto).
  assert (0 <= w) by auto. assert (m <= v) by auto. nra.
Qed.

Lemma dot_of_hull d ws vs p :
  weighted ws (map x vs) == x p -> weighted ws (map y vs) == y p -> weighted ws (map z vs) == z p ->
  weighted ws (map (dotq d) vs) == dotq d p.
Proof. intros X Y Z. rewrite weighted_dot, X, Y, Z. reflexivity. Qed.

Lemma hull_le d m vs p : hull vs p -> (forall v, In v vs -> dotq d v <= m) -> dotq d p <= m.
Proof.
  intros (ws & L & P & S & X & Y & Z) H.
  assert (weighted ws (map (dotq d) vs) <= m * sum ws) as W.
  { apply weighted_le; auto. - intros v I. apply in_map_iff in I. destruct I as (u & <- & I). auto.
    - now rewrite map_length. }
  rewrite (dot_of_hull d ws vs p X Y Z), S in W. lra.
Qed.
Lemma hull_ge d m vs p : hull vs p -> (forall v, In v vs -> m <= dotq d v) -> m <= dotq d p.
Proof.
  intros (ws & L & P & S & X & Y & Z) H.
  assert (m * sum ws <= weighted ws (map (dotq d) vs)) as W.
  { apply weighted_ge; auto. - intros v I. apply in_map_iff in I. destruct I as (u & <- & I). auto.
    - now rewrite map_length. }
  rewrite (dot_of_hull d ws vs p X Y Z), S in W. lra.
Qed.

(** * Separating directions *)

Lemma highest_spec d ps : forall acc top,
  fold_left (fun top p => match top with None => Some (dot d p) | Some v => Some (Z.max v (dot d p)) end) ps acc
    = Some top ->
  (forall p, In p ps -> (dot d p <= top)%Z) /\ (forall v, acc = Some v -> (v <= top)%Z).
Proof.
  induction ps as [| p ps IH]; cbn; intros acc top H.
  - split; [tauto | intros v E; rewrite E in H; injection H; lia].
  - destruct acc as [v |]; apply IH in H; destruct H as [A B]; specialize (B _ eq_refl); split.
    + intros q [<- | I]; auto. lia.
    + intros u E; injection E; lia.
    + intros q [<- | I]; auto.
    + discriminate.
Qed.

Lemma all_below_spec below d ps qs : all_below below d ps qs = true ->
  is_zero d = false /\ exists top, (forall p, In p ps -> (dot d p <= top)%Z) /\
                                   (forall q, In q qs -> below top (dot d q) = true).
Proof.
  unfold all_below. intros H. apply andb_true_iff in H. destruct H as [N H].
  split; [now destruct (is_zero d) |].
  destruct (highest d ps) as [top |] eqn:E; [| discriminate].
  exists top. split; [exact (proj1 (highest_spec d ps None top E)) |].
  intros q I. rewrite forallb_forall in H. auto.
Qed.

Lemma in_rational v vs : In v (map rational vs) -> exists u, v = rational u /\ In u vs.
Proof. intros I. apply in_map_iff in I. destruct I as (u & <- & I). eauto. Qed.

Definition apart (vs us : list point) : Prop := ~ meet vs us.

Lemma below_apart d ps qs : all_below Z.ltb d ps qs = true -> forall ps' qs', incl ps' ps -> incl qs' qs ->
  apart (map rational ps') (map rational qs').
Proof.
  intros H ps' qs' Ip Iq. apply all_below_spec in H. destruct H as (_ & top & A & B).
  intros (p & q & Hp & Hq & X & Y & Z); cbn in X, Y, Z.
  assert (dotq (rational d) p <= inject_Z top) as Lp.
  { apply (hull_le _ _ (map rational ps')); auto. intros v I. apply in_rational in I. destruct I as (u & -> & I).
    rewrite <- inject_dot. apply inject_le. auto. }
  assert (inject_Z (top + 1) <= dotq (rational d) q) as Lq.
  { apply (hull_ge _ _ (map rational qs')); auto. intros v I. apply in_rational in I. destruct I as (u & -> & I).
    rewrite <- inject_dot. apply inject_le. apply Iq, B, Z.ltb_lt in I. lia. }
  assert (dotq (rational d) p == dotq (rational d) q) as E.
  { unfold dotq. rewrite X, Y, Z. ring. }
  rewrite inject_Z_plus in Lq. change (inject_Z 1) with 1 in Lq. lra.
Qed.

Lemma below_parts d ps qs : all_below Z.leb d ps qs = true -> forall eps, 0 < eps ->
  exists t, shorter eps t /\ ~ meet_moved t (map rational ps) (map rational qs).
Proof.
  intros H eps Heps. apply all_below_spec in H. destruct H as (N & top & A & B).
  set (n := inject_Z (1 + Z.abs (x d) + Z.abs (y d) + Z.abs (z d))).
  assert (0 < n) as Hn by (change 0 with (inject_Z 0); apply inject_lt; lia).
  set (f := eps / n). assert (0 < f) as Hf by (apply Qlt_shift_div_l; lra).
  assert (f * n == eps) as Fn by (unfold f; field; lra).
  assert (forall a, (Z.abs a < 1 + Z.abs (x d) + Z.abs (y d) + Z.abs (z d))%Z ->
                    - eps < f * inject_Z a /\ f * inject_Z a < eps) as Bound.
  { intros a Ha. assert (inject_Z a < n) by (apply inject_lt; lia).
    assert (- n < inject_Z a) by (unfold n; rewrite <- inject_Z_opp; apply inject_lt; lia). rewrite <- Fn. nra. }
  exists (Triple (f * inject_Z (x d)) (f * inject_Z (y d)) (f * inject_Z (z d))).
  split; [repeat split; cbn; apply Bound; lia |].
  intros (p & q & Hp & Hq & X & Y & Z); cbn in X, Y, Z.
  assert (dotq (rational d) p <= inject_Z top) as Lp.
  { apply (hull_le _ _ (map rational ps)); auto. intros v I. apply in_rational in I. destruct I as (u & -> & I).
    rewrite <- inject_dot. apply inject_le. auto. }
  assert (inject_Z top <= dotq (rational d) q) as Lq.
  { apply (hull_ge _ _ (map rational qs)); auto. intros v I. apply in_rational in I. destruct I as (u & -> & I).
    rewrite <- inject_dot. apply inject_le. apply B, Z.leb_le in I. lia. }
  assert (dotq (rational d) p == dotq (rational d) q + f * inject_Z (dot d d)) as E.
  { rewrite inject_dot. unfold dotq. rewrite X, Y, Z. unfold rational, map3; cbn. ring. }
  assert (1 <= inject_Z (dot d d)).
  { change 1 with (inject_Z 1). apply inject_le. unfold is_zero in N. unfold dot.
    destruct (Z.eqb_spec (x d) 0), (Z.eqb_spec (y d) 0), (Z.eqb_spec (z d) 0); try discriminate; nia. }
  nra.
Qed.

(** * Distances and translations *)

(** What the measure asks of two faces. *)
Definition related (m : measure) : list point -> list point -> Prop :=
  match m with
  | Sharing => meet
  | Distance w strict => near (inject_Z w) strict
  | Moving t => meet_along (rational t)
  end.

Lemma lowest_exists (f : point -> Q) u vs : exists v, In v (u :: vs) /\ forall w, In w (u :: vs) -> f v <= f w.
Proof.
  revert u; induction vs as [| a vs IH]; intros u.
  - exists u. split; [now left |]. intros w [<- | []]. lra.
  - destruct (IH a) as (v & I & L). destruct (Qlt_le_dec (f u) (f v)).
    + exists u. split; [now left |]. intros w [<- | J]; [lra |]. apply L in J. lra.
    + exists v. split; [now right |]. intros w [<- | J]; [lra | auto].
Qed.
(** A vertex lies at most as high as a point of the hull. *)
Lemma lowest_vertex d vs p : hull vs p -> exists v, In v vs /\ dotq d v <= dotq d p.
Proof.
  intros H. destruct vs as [| u vs].
  - destruct H as ([| w ws] & L & _ & S & _); cbn in *; [lra | discriminate].
  - destruct (lowest_exists (dotq d) u vs) as (v & I & L). exists v. split; auto. now apply (hull_ge _ _ (u :: vs)).
Qed.

Lemma top_of_hull d top ps ps' p : (forall p, In p ps -> (dot d p <= top)%Z) -> incl ps' ps ->
  hull (map rational ps') p -> dotq (rational d) p <= inject_Z top.
Proof.
  intros A I H. apply (hull_le _ _ (map rational ps')); auto. intros v J. apply in_rational in J.
  destruct J as (u & -> & J). rewrite <- inject_dot. apply inject_le. auto.
Qed.

(** The inequality of Cauchy and Schwarz. *)
Lemma dot_square d e : dotq d e * dotq d e <= dotq d d * dotq e e.
Proof.
  unfold dotq. set (a := x d * y e - y d * x e). set (b := y d * z e - z d * y e). set (c := z d * x e - x d * z e).
  assert (0 <= a * a) by (destruct (Qlt_le_dec a 0); nra). assert (0 <= b * b) by (destruct (Qlt_le_dec b 0); nra).
  assert (0 <= c * c) by (destruct (Qlt_le_dec c 0); nra). unfold a, b, c in *. lra.
Qed.

Lemma dot_self_positive d : is_zero d = false -> (0 < dot d d)%Z.
Proof.
  unfold is_zero, dot. intros N. destruct (Z.eqb_spec (x d) 0), (Z.eqb_spec (y d) 0), (Z.eqb_spec (z d) 0);
    try discriminate; nia.
Qed.

Lemma gap_far w strict d ps qs : separates (Distance w strict) d ps qs = true -> forall ps' qs',
  incl ps' ps -> incl qs' qs ->
  ~ near (inject_Z w) strict (map rational ps') (map rational qs').
Proof.
  intros H ps' qs' Ip Iq (p & q & Hp & Hq & Near). cbn [separates] in H.
  apply all_below_spec in H. destruct H as (N & top & A & B).
  pose proof (top_of_hull d top ps ps' p A Ip Hp) as Lp.
  destruct (lowest_vertex (rational d) _ q Hq) as (v & I & Lq). apply in_rational in I. destruct I as (u & -> & I).
  rewrite <- inject_dot in Lq. specialize (B u (Iq u I)). cbv zeta in B, Near.
  apply andb_true_iff in B. destruct B as (Positive & B). apply Z.ltb_lt in Positive.
  pose proof (dot_self_positive d N) as Dd. apply inject_lt in Dd. change (inject_Z 0) with 0 in Dd.
  set (gap := (dot d u - top)%Z) in *. set (g := inject_Z gap).
  assert (0 < g) as G by (change 0 with (inject_Z 0); now apply inject_lt).
  assert (g == inject_Z (dot d u) - inject_Z top) as Eg.
  { unfold g, gap, Zminus. now rewrite inject_Z_plus, inject_Z_opp. }
  pose (e := Triple (x p - x q) (y p - y q) (z p - z q)).
  assert (dotq (rational d) e == dotq (rational d) p - dotq (rational d) q) as Ee by (unfold dotq, e; cbn; ring).
  pose proof (dot_square (rational d) e) as Cauchy. rewrite <- (inject_dot d d) in Cauchy.
  set (dd := inject_Z (dot d d)) in *. set (de := dotq (rational d) e) in *.
  assert (g * g <= de * de) as Le by (assert (g <= - de) by lra; nra).
  change (dotq e e) with ((x p - x q) * (x p - x q) + (y p - y q) * (y p - y q) + (z p - z q) * (z p - z q)) in Cauchy.
  set (square := (x p - x q) * (x p - x q) + (y p - y q) * (y p - y q) + (z p - z q) * (z p - z q)) in *.
  set (ww := inject_Z w * inject_Z w) in *.
  assert (inject_Z (w * w * dot d d) == ww * dd) as El by (unfold ww, dd; now rewrite !inject_Z_mult).
  assert (inject_Z (gap * gap) == g * g) as Eq by (unfold g; now rewrite inject_Z_mult).
  destruct strict.
  - apply Z.leb_le, inject_le in B. rewrite El, Eq in B. assert (dd * square < ww * dd) by nra. lra.
  - apply Z.ltb_lt, inject_lt in B. rewrite El, Eq in B. assert (dd * square <= ww * dd) by nra. lra.
Qed.

Lemma never_met t d ps qs : separates (Moving t) d ps qs = true -> forall ps' qs', incl ps' ps -> incl qs' qs ->
  ~ meet_along (rational t) (map rational ps') (map rational qs').
Proof.
  intros H ps' qs' Ip Iq (k & K & p & q & Hp & Hq & X & Y & Z). cbn [x y z] in X, Y, Z.
  assert (dotq (rational d) p == dotq (rational d) q + k * inject_Z (dot d t)) as E.
  { rewrite inject_dot. unfold dotq. rewrite X, Y, Z. ring. }
  destruct (lowest_vertex (rational d) _ q Hq) as (v & I & Lq). apply in_rational in I. destruct I as (u & -> & I).
  rewrite <- inject_dot in Lq. cbn [separates] in H. cbv zeta in H. destruct (Z.ltb_spec 0 (dot d t)) as [Rise | _].
  - apply all_below_spec in H. destruct H as (_ & top & A & B). pose proof (top_of_hull d top ps ps' p A Ip Hp) as Lp.
    apply inject_lt in Rise. change (inject_Z 0) with 0 in Rise.
    specialize (B u (Iq u I)). apply Z.leb_le, inject_le in B. assert (0 < k * inject_Z (dot d t)) by nra. lra.
  - apply andb_true_iff in H. destruct H as (Zero & H). apply Z.eqb_eq in Zero. rewrite Zero in E.
    apply all_below_spec in H. destruct H as (_ & top & A & B). pose proof (top_of_hull d top ps ps' p A Ip Hp) as Lp.
    change (inject_Z 0) with 0 in E. specialize (B u (Iq u I)). apply Z.ltb_lt, inject_lt in B. lra.
Qed.

Lemma separates_sound m d ps qs : separates m d ps qs = true -> forall ps' qs', incl ps' ps -> incl qs' qs ->
  ~ related m (map rational ps') (map rational qs').
Proof. destruct m; [exact (below_apart d ps qs) | exact (gap_far w strict d ps qs) | exact (never_met t d ps qs)]. Qed.

(** Along d every point of vs lies between two of ps. *)
Definition spans (d : triple Z) (ps vs : list (triple Z)) : Prop :=
  forall v, In v vs -> exists p q, In p ps /\ In q ps /\ (dot d p <= dot d v <= dot d q)%Z.

Lemma all_below_spans below d ps qs ps' qs' :
  (forall top v w, (v <= w)%Z -> below top v = true -> below top w = true) -> spans d ps ps' -> spans d qs qs' ->
  all_below below d ps qs = true -> all_below below d (ps ++ ps') (qs ++ qs') = true.
Proof.
  intros Up P Q. unfold all_below. rewrite !andb_true_iff. intros (N & H). split; [auto |].
  destruct (highest d ps) as [top |] eqn:E; [| discriminate].
  assert (highest d (ps ++ ps') = Some top) as ->.
  { pose proof (proj1 (highest_spec d ps None top E)) as Top. unfold highest in *. rewrite fold_left_app, E. clear E.
    induction ps' as [| v vs IH]; cbn; [auto |]. destruct (P v (or_introl eq_refl)) as (_ & q & _ & I & _ & L).
    specialize (Top q I). rewrite Z.max_l by lia. apply IH. intros u J. apply P. now right. }
  rewrite forallb_app, H. cbn. rewrite forallb_forall in *. intros v I. destruct (Q v I) as (q & _ & J & _ & L & _).
  apply (Up top (dot d q)); auto.
Qed.

Lemma separates_spans m d ps qs ps' qs' : separates m d ps qs = true -> spans d ps ps' -> spans d qs qs' ->
  ~ related m (map rational ps') (map rational qs').
Proof.
  intros H P Q. apply (separates_sound m d (ps ++ ps') (qs ++ qs')); try apply incl_appr, incl_refl.
  assert (forall top v w, (v <= w)%Z -> (top <? v)%Z = true -> (top <? w)%Z = true) as Lt
    by (intros top v w; rewrite !Z.ltb_lt; lia).
  destruct m as [| w strict | t]; cbn in *; cbv zeta in *.
  - revert H. now apply all_below_spans.
  - revert H. apply all_below_spans; auto. intros top u v L. rewrite !andb_true_iff, !Z.ltb_lt.
    destruct strict; rewrite ?Z.leb_le, ?Z.ltb_lt; nia.
  - destruct (0 <? dot d t)%Z.
    + revert H. apply all_below_spans; auto. intros top u v. rewrite !Z.leb_le. lia.
    + rewrite andb_true_iff in *. destruct H as (Z & H). split; [auto |]. revert H. now apply all_below_spans.
Qed.

(** * Common points *)

Lemma same_length_spec {S T} (l : list S) (m : list T) : same_length l m = true -> length l = length m.
Proof. revert m; induction l as [| a l IH]; intros [| b m] H; cbn in *; try discriminate; auto. Qed.

(** p is a mean of vs with weights that are at least b. *)
Definition inside (b : Q) (vs : list point) (p : point) : Prop :=
  exists ws, length ws = length vs /\ (forall w, In w ws -> b <= w) /\ sum ws == 1 /\
    weighted ws (map x vs) == x p /\ weighted ws (map y vs) == y p /\ weighted ws (map z vs) == z p.
Definition close (b : Q) (t : point) (vs us : list point) : Prop :=
  exists p q, inside b vs p /\ inside b us q /\ x p == x q + x t /\ y p == y q + y t /\ z p == z q + z t.

Lemma inside_less b c vs p : c <= b -> inside b vs p -> inside c vs p.
Proof. intros H (ws & L & B & R). exists ws. split; [| split]; auto. intros w I. apply B in I. lra. Qed.
Lemma close_meets b t vs us : 0 <= b -> close b t vs us -> meet_moved t vs us.
Proof.
  intros H (p & q & P & Q & R). exists p, q.
  split; [apply (inside_less b 0); auto |]. split; [apply (inside_less b 0); auto | auto].
Qed.

Lemma scaled_sum t ws : sum (map (fun w => inject_Z w / t) ws) == inject_Z (sum_z ws) / t.
Proof.
  induction ws as [| w ws IH]; cbn; [unfold Qdiv; ring |]. rewrite IH, inject_Z_plus. unfold Qdiv. ring.
Qed.
Lemma scaled_weighted t (f : triple Z -> Z) ws : forall vs,
  weighted (map (fun w => inject_Z w / t) ws) (map (fun v => inject_Z (f v)) vs)
  == inject_Z (weighted_z ws (map f vs)) / t.
Proof.
  induction ws as [| w ws IH]; intros [| v vs]; cbn; try (unfold Qdiv; ring).
  rewrite IH, inject_Z_plus, inject_Z_mult. unfold Qdiv. ring.
Qed.

Lemma inside_of_weights least ws vs : let total := inject_Z (sum_z ws) in
  at_least least ws = true -> (0 < sum_z ws)%Z -> length ws = length vs ->
  inside (inject_Z least / total) (map rational vs)
    (Triple (inject_Z (weighted_z ws (map x vs)) / total) (inject_Z (weighted_z ws (map y vs)) / total)
            (inject_Z (weighted_z ws (map z vs)) / total)).
Proof.
  intros total H T L. assert (0 < total) as P by (change 0 with (inject_Z 0); now apply inject_lt).
  exists (map (fun w => inject_Z w / total) ws). split; [now rewrite !map_length |]. split.
  - intros w I. apply in_map_iff in I. destruct I as (v & <- & I).
    unfold at_least in H. rewrite forallb_forall in H. apply H, Z.leb_le, inject_le in I.
    apply Qle_shift_div_l; [lra |]. setoid_replace (inject_Z least / total * total) with (inject_Z least) by (field; lra).
    auto.
  - split; [rewrite scaled_sum; fold total; field; lra |].
    rewrite !map_map. cbn. rewrite !scaled_weighted. repeat split; reflexivity.
Qed.

Lemma same_point_close la lb wa wb pa pb :
  at_least la wa = true -> at_least lb wb = true -> same_point wa wb pa pb = true ->
  (0 < sum_z wa)%Z /\ (0 < sum_z wb)%Z /\
  exists p q, inside (inject_Z la / inject_Z (sum_z wa)) (map rational pa) p /\
              inside (inject_Z lb / inject_Z (sum_z wb)) (map rational pb) q /\
              x p == x q + 0 /\ y p == y q + 0 /\ z p == z q + 0.
Proof.
  unfold same_point. rewrite !andb_true_iff, !Z.ltb_lt, !Z.eqb_eq. intros A B ((((((Ta & Tb) & La) & Lb) & X) & Y) & W).
  split; auto. split; auto.
  assert (0 < inject_Z (sum_z wa)) by (change 0 with (inject_Z 0); now apply inject_lt).
  assert (0 < inject_Z (sum_z wb)) by (change 0 with (inject_Z 0); now apply inject_lt).
  eexists. eexists. split; [apply inside_of_weights; auto; now apply same_length_spec |].
  split; [apply inside_of_weights; auto; now apply same_length_spec |]. cbn.
  assert (forall a b c d : Z, (0 < c)%Z -> (0 < d)%Z -> (a * d = b * c)%Z ->
            inject_Z a / inject_Z c == inject_Z b / inject_Z d + 0) as E.
  { intros a b c d Hc Hd E. assert (0 < inject_Z c) by (change 0 with (inject_Z 0); now apply inject_lt).
    assert (0 < inject_Z d) by (change 0 with (inject_Z 0); now apply inject_lt).
    assert (inject_Z a * inject_Z d == inject_Z b * inject_Z c) as E' by (rewrite <- !inject_Z_mult, E; reflexivity).
    setoid_replace (inject_Z a / inject_Z c) with ((inject_Z a * inject_Z d) / (inject_Z c * inject_Z d)) by (field; lra).
    rewrite E'. field. lra. }
  auto.
Qed.

Lemma same_point_meet wa wb pa pb :
  at_least 0 wa = true -> at_least 0 wb = true -> same_point wa wb pa pb = true ->
  meet (map rational pa) (map rational pb).
Proof.
  intros A B S. destruct (same_point_close 0 0 wa wb pa pb A B S) as (_ & _ & p & q & P & Q & E).
  exists p, q. cbn. split; [| split]; auto; (eapply inside_less; [| eassumption]); change (inject_Z 0) with 0;
    unfold Qdiv; lra.
Qed.

Lemma close_points_near w strict wa wb pa pb :
  at_least 0 wa = true -> at_least 0 wb = true -> close_points w strict wa wb pa pb = true ->
  near (inject_Z w) strict (map rational pa) (map rational pb).
Proof.
  unfold close_points. cbv zeta. rewrite !andb_true_iff, !Z.ltb_lt. intros A B ((((Ta & Tb) & La) & Lb) & D).
  apply same_length_spec in La. apply same_length_spec in Lb.
  pose proof (inside_of_weights 0 wa pa A Ta La) as Ha. pose proof (inside_of_weights 0 wb pb B Tb Lb) as Hb.
  apply inject_lt in Ta. apply inject_lt in Tb. change (inject_Z 0) with 0 in *. cbv zeta in Ha, Hb.
  eexists. eexists. split; [eapply (inside_less _ 0); [| exact Ha]; unfold Qdiv; lra |].
  split; [eapply (inside_less _ 0); [| exact Hb]; unfold Qdiv; lra |]. cbv zeta. cbn [x y z].
  set (ta := inject_Z (sum_z wa)) in *. set (tb := inject_Z (sum_z wb)) in *.
  assert (forall f : triple Z -> Z, inject_Z (weighted_z wa (map f pa)) / ta - inject_Z (weighted_z wb (map f pb)) / tb
            == inject_Z (weighted_z wa (map f pa) * sum_z wb - weighted_z wb (map f pb) * sum_z wa) / (ta * tb)) as E.
  { intros f. unfold Zminus. rewrite inject_Z_plus, inject_Z_opp, !inject_Z_mult. fold ta tb. field. lra. }
  pose proof (E x) as Ex. pose proof (E y) as Ey. pose proof (E z) as Ez. clear E.
  set (dx := (weighted_z wa (map x pa) * sum_z wb - weighted_z wb (map x pb) * sum_z wa)%Z) in *.
  set (dy := (weighted_z wa (map y pa) * sum_z wb - weighted_z wb (map y pb) * sum_z wa)%Z) in *.
  set (dz := (weighted_z wa (map z pa) * sum_z wb - weighted_z wb (map z pb) * sum_z wa)%Z) in *.
  assert (0 < ta * tb) as P by nra. set (t := ta * tb) in *.
  assert (0 < t * t) as Pt by nra.
  assert (inject_Z dx / t * (inject_Z dx / t) + inject_Z dy / t * (inject_Z dy / t)
            + inject_Z dz / t * (inject_Z dz / t)
          == inject_Z (dot (Triple dx dy dz) (Triple dx dy dz)) / (t * t)) as Square.
  { unfold dot; cbn [x y z]. rewrite !inject_Z_plus, !inject_Z_mult. field. lra. }
  assert (inject_Z (w * sum_z wa * sum_z wb * (w * sum_z wa * sum_z wb)) == inject_Z w * inject_Z w * (t * t)) as M.
  { rewrite !inject_Z_mult. fold ta tb. unfold t. ring. }
  destruct strict; rewrite Ex, Ey, Ez, Square.
  - apply Z.ltb_lt, inject_lt in D. rewrite M in D. now apply Qlt_shift_div_r.
  - apply Z.leb_le, inject_le in D. rewrite M in D. now apply Qle_shift_div_r.
Qed.

(** * Crossing: weights above 0 leave room in three directions *)

Fixpoint add_at (k : nat) (c : Q) (ws : list Q) : list Q :=
  match ws, k with
  | w :: rest, O => (w + c) :: rest
  | w :: rest, S k => w :: add_at k c rest
  | [], _ => []
  end.

Lemma add_at_spec k c : forall ws (vs : list point) v, length ws = length vs -> nth_error vs k = Some v ->
  length (add_at k c ws) = length vs /\ sum (add_at k c ws) == sum ws + c /\
  forall f : point -> Q, weighted (add_at k c ws) (map f vs) == weighted ws (map f vs) + c * f v.
Proof.
  induction k as [| k IH]; intros [| w ws] [| u vs] v L E; cbn in *; try discriminate.
  - injection E as ->. split; auto. split; [ring | intros f; ring].
  - injection L as L. destruct (IH ws vs v L E) as (L' & S & W). split; [auto |]. split; [rewrite S; ring |].
    intros f. rewrite W. ring.
Qed.
Lemma add_at_least b r k c : - r <= c -> 0 <= r -> forall ws, (forall w, In w ws -> b <= w) ->
  forall w, In w (add_at k c ws) -> b - r <= w.
Proof.
  intros Hc Hr. induction k as [| k IH]; intros [| u ws] B w I; cbn in *; try tauto.
  - destruct I as [<- | I]; [assert (b <= u) by auto; lra | assert (b <= w) by auto; lra].
  - destruct I as [<- | I]; [assert (b <= u) by auto; lra |]. apply (IH ws); auto.
Qed.

Definition moved (p : point) (c : Q) (v : point) : point :=
  Triple (x p + c * x v) (y p + c * y v) (z p + c * z v).
Definition minus (p q : point) : point := Triple (x p - x q) (y p - y q) (z p - z q).

Lemma inside_moved b r c k vs p u v : inside b vs p -> nth_error vs 0 = Some u -> nth_error vs k = Some v ->
  0 <= r -> - r <= c -> c <= r -> inside (b - 2 * r) vs (moved p c (minus v u)).
Proof.
  intros (ws & L & B & S & X & Y & Z) U V Hr H1 H2.
  destruct (add_at_spec k c ws vs v L V) as (L1 & S1 & W1).
  destruct (add_at_spec 0 (- c) (add_at k c ws) vs u L1 U) as (L2 & S2 & W2).
  exists (add_at 0 (- c) (add_at k c ws)). split; [auto |]. split.
  - intros w I. apply (add_at_least (b - r) r 0 (- c)) in I; auto; [lra | lra |].
    apply (add_at_least b r k c); auto.
  - split; [rewrite S2, S1, S; ring |]. rewrite !W2, !W1, X, Y, Z. cbn. repeat split; ring.
Qed.

Lemma nth_rational ps k p : nth_error ps k = Some p -> nth_error (map rational ps) k = Some (rational p).
Proof. apply map_nth_error. Qed.

Lemma close_moved b r c t pa pb e v : close b t (map rational pa) (map rational pb) -> vector pa pb e = Some v ->
  0 <= r -> - r <= c -> c <= r ->
  close (b - 2 * r) (moved t c (rational v)) (map rational pa) (map rational pb).
Proof.
  intros (p & q & P & Q & X & Y & Z) E Hr H1 H2. unfold vector in E.
  destruct (edge_of e).
  - destruct (nth_error pa 0) as [u0 |] eqn:U; [| discriminate].
    destruct (nth_error pa (edge_to e)) as [u1 |] eqn:V; [| discriminate]. injection E as <-.
    apply nth_rational in U. apply nth_rational in V.
    exists (moved p c (minus (rational u1) (rational u0))), q. split; [eapply inside_moved; eauto |].
    split; [apply (inside_less b); [lra | auto] |].
    unfold moved, minus, rational, map3; cbn. rewrite X, Y, Z. unfold Zminus. rewrite !inject_Z_plus, !inject_Z_opp.
    repeat split; ring.
  - destruct (nth_error pb 0) as [u0 |] eqn:U; [| discriminate].
    destruct (nth_error pb (edge_to e)) as [u1 |] eqn:V; [| discriminate]. injection E as <-.
    apply nth_rational in U. apply nth_rational in V.
    exists p, (moved q (- c) (minus (rational u1) (rational u0))). split; [apply (inside_less b); [lra | auto] |].
    split; [eapply inside_moved; eauto; lra |].
    unfold moved, minus, rational, map3; cbn. rewrite X, Y, Z. unfold Zminus. rewrite !inject_Z_plus, !inject_Z_opp.
    repeat split; ring.
Qed.

Lemma product_bound e n t a : - e < t -> t < e -> - n <= a -> a <= n -> - (e * n) <= t * a /\ t * a <= e * n.
Proof. intros. nra. Qed.

Definition cofactors (a b : point) : point :=
  Triple (y a * z b - z a * y b) (z a * x b - x a * z b) (x a * y b - y a * x b).

Lemma exists_bound (n : point) : exists k, 0 < k /\ forall eps t, shorter eps t ->
  - (eps * k) <= dotq n t /\ dotq n t <= eps * k.
Proof.
  assert (forall a : Q, exists m, 0 <= m /\ - m <= a /\ a <= m) as A.
  { intros a. destruct (Qlt_le_dec a 0); [exists (- a) | exists a]; lra. }
  destruct (A (x n)) as (mx & X0 & X1 & X2), (A (y n)) as (my & Y0 & Y1 & Y2), (A (z n)) as (mz & Z0 & Z1 & Z2).
  exists (1 + mx + my + mz). split; [lra |]. intros eps t ((Tx & Tx') & (Ty & Ty') & (Tz & Tz')).
  pose proof (product_bound eps mx (x t) (x n) Tx Tx' X1 X2).
  pose proof (product_bound eps my (y t) (y n) Ty Ty' Y1 Y2).
  pose proof (product_bound eps mz (z t) (z n) Tz Tz' Z1 Z2).
  unfold dotq. nra.
Qed.

Lemma cross_of_span m pa pb e1 e2 e3 a b c : 0 < m ->
  close m (Triple 0 0 0) (map rational pa) (map rational pb) ->
  vector pa pb e1 = Some a -> vector pa pb e2 = Some b -> vector pa pb e3 = Some c -> determinant a b c <> 0%Z ->
  cross (map rational pa) (map rational pb).
Proof.
  intros Hm C A B D N.
  set (qa := rational a); set (qb := rational b); set (qc := rational c).
  set (n1 := cofactors qb qc); set (n2 := cofactors qc qa); set (n3 := cofactors qa qb).
  set (det := dotq n1 qa).
  assert (det == inject_Z (determinant a b c)) as Hdet.
  { unfold det, n1, dotq, cofactors, qa, qb, qc, determinant, rational, map3; cbn. unfold Zminus.
    rewrite !inject_Z_plus, !inject_Z_mult, !inject_Z_plus, !inject_Z_opp, !inject_Z_mult. ring. }
  assert (~ det == 0) as Hnot.
  { rewrite Hdet. change 0 with (inject_Z 0). rewrite inject_Z_injective. auto. }
  assert (- (1) <= / det /\ / det <= 1) as (I1 & I2).
  { assert (det * / det == 1) by (field; auto). set (i := / det) in *.
    assert (1 <= det \/ det <= - (1)) as [G | G].
    { rewrite Hdet. destruct (Z_lt_le_dec (determinant a b c) 0).
      - right. change (- (1)) with (inject_Z (-1)). apply inject_le. lia.
      - left. change 1 with (inject_Z 1). apply inject_le. lia. }
    - nra.
    - nra. }
  destruct (exists_bound n1) as (k1 & K1 & L1), (exists_bound n2) as (k2 & K2 & L2), (exists_bound n3) as (k3 & K3 & L3).
  set (r := m / 6). assert (6 * r == m) as Hr by (unfold r; field).
  set (eps := r / (k1 + k2 + k3)). assert (eps * (k1 + k2 + k3) == r) as Heps by (unfold eps; field; lra).
  assert (0 < eps) as Pe by (apply Qlt_shift_div_l; lra).
  exists eps. split; [auto |]. intros t T.
  assert (forall n k, 0 < k -> k <= k1 + k2 + k3 -> - (eps * k) <= dotq n t /\ dotq n t <= eps * k ->
            - r <= dotq n t * / det /\ dotq n t * / det <= r) as Bound.
  { intros n k P Le (G1 & G2). set (u := dotq n t) in *. set (i := / det) in *.
    assert (eps * k <= r) by nra. assert (- r <= u) by lra. assert (u <= r) by lra. assert (0 < r) by lra. split; nra. }
  destruct (Bound n1 k1 K1 ltac:(lra) (L1 _ _ T)) as (B1 & B1').
  destruct (Bound n2 k2 K2 ltac:(lra) (L2 _ _ T)) as (B2 & B2').
  destruct (Bound n3 k3 K3 ltac:(lra) (L3 _ _ T)) as (B3 & B3').
  pose proof (close_moved _ r _ _ _ _ _ _ C A ltac:(lra) B1 B1') as C1.
  pose proof (close_moved _ r _ _ _ _ _ _ C1 B ltac:(lra) B2 B2') as C2.
  pose proof (close_moved _ r _ _ _ _ _ _ C2 D ltac:(lra) B3 B3') as C3.
  apply close_meets in C3; [| lra].
  destruct C3 as (p & q & P & Q & X & Y & Z). exists p, q. split; [auto |]. split; [auto |].
  rewrite X, Y, Z. fold qa qb qc.
  assert (det * / det == 1) as One by (field; auto).
  generalize dependent (/ det). intros i. intros.
  assert (forall u v, v == det * i * u -> v == u) as Cramer by (intros u v ->; rewrite One; ring).
  unfold moved; cbn. repeat split; (apply Qplus_comp; [reflexivity |]); apply Cramer;
    unfold det, n1, n2, n3, dotq, cofactors, qa, qb, qc, rational, map3; cbn; ring.
Qed.

Lemma positive_least wa wb pa pb : at_least 1 wa = true -> at_least 1 wb = true -> same_point wa wb pa pb = true ->
  exists m, 0 < m /\ close m (Triple 0 0 0) (map rational pa) (map rational pb).
Proof.
  intros A B S. destruct (same_point_close 1 1 wa wb pa pb A B S) as (Ta & Tb & p & q & P & Q & E).
  apply inject_lt in Ta. apply inject_lt in Tb. change (inject_Z 0) with 0 in *.
  set (ma := inject_Z 1 / inject_Z (sum_z wa)) in *. set (mb := inject_Z 1 / inject_Z (sum_z wb)) in *.
  assert (0 < ma) by (apply Qlt_shift_div_l; [lra | change (inject_Z 1) with 1; lra]).
  assert (0 < mb) by (apply Qlt_shift_div_l; [lra | change (inject_Z 1) with 1; lra]).
  destruct (Qlt_le_dec ma mb).
  - exists ma. split; auto. exists p, q. split; auto. split; auto. apply (inside_less mb); auto. lra.
  - exists mb. split; auto. exists p, q. split; [apply (inside_less ma); auto |]. split; auto.
Qed.

(** * What a cell of one pair proves *)

Lemma at_least_less l ws : at_least 1 ws = true -> (l <= 1)%Z -> at_least l ws = true.
Proof.
  unfold at_least. rewrite !forallb_forall. intros H L w I. apply H in I. rewrite Z.leb_le in *. lia.
Qed.

Lemma reason_sound m why wa wb pa pb : reason_holds m why wa wb pa pb = true ->
  related m (map rational pa) (map rational pb) /\
  match why with
  | Meet | Near => True
  | Touch _ => touch (map rational pa) (map rational pb)
  | Cross _ _ _ => cross (map rational pa) (map rational pb)
  end.
Proof.
  intros H. destruct m as [| w strict |], why as [| | d | e1 e2 e3]; cbn in H; try discriminate;
    rewrite !andb_true_iff in H.
  - split; auto. apply (same_point_meet wa wb); tauto.
  - assert (meet (map rational pa) (map rational pb)) by (apply (same_point_meet wa wb); tauto).
    split; auto. split; auto. intros eps P. apply (below_parts d); tauto.
  - destruct H as (((S & A) & B) & H). split.
    + apply (same_point_meet wa wb); auto; apply at_least_less; auto; lia.
    + destruct (vector pa pb e1) as [a |] eqn:E1; [| discriminate].
      destruct (vector pa pb e2) as [b |] eqn:E2; [| discriminate].
      destruct (vector pa pb e3) as [c |] eqn:E3; [| discriminate].
      destruct (positive_least wa wb pa pb A B S) as (m & P & C).
      apply (cross_of_span m pa pb e1 e2 e3 a b c); auto.
      destruct (Z.eqb_spec (determinant a b c) 0); [discriminate | auto].
  - split; auto. apply (close_points_near w strict wa wb); tauto.
Qed.
