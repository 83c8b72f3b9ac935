; The median of gyro triads, one component (docs/theory.md, T15): of three with one that reads anything, and of five with
; two, it lies between two healthy ones; with one fault more it need not.
; Verifies: REQ-214
(set-logic QF_LRA)
(define-fun least ((a Real) (b Real)) Real (ite (< a b) a b))
(define-fun most ((a Real) (b Real)) Real (ite (< a b) b a))
(define-fun median3 ((a Real) (b Real) (c Real)) Real (most (least a b) (least (most a b) c)))
; Of five: that of e and of what is left of a to d without their least and their most.
(define-fun median5 ((a Real) (b Real) (c Real) (d Real) (e Real)) Real
  (median3 e (most (least a b) (least c d)) (least (most a b) (most c d))))
(declare-const h1 Real)
(declare-const h2 Real)
(declare-const h3 Real)
(declare-const f1 Real)
(declare-const f2 Real)

; Healthy h1 and h2, f1 anything, in every order.
; expect: unsat
(push)
(assert (not (and (<= (least h1 h2) (median3 h1 h2 f1)) (<= (median3 h1 h2 f1) (most h1 h2))
                  (<= (least h1 h2) (median3 h1 f1 h2)) (<= (median3 h1 f1 h2) (most h1 h2))
                  (<= (least h1 h2) (median3 f1 h1 h2)) (<= (median3 f1 h1 h2) (most h1 h2)))))
(check-sat)
(pop)

; Healthy h1, h2 and h3 of five.
(define-fun low () Real (least h1 (least h2 h3)))
(define-fun high () Real (most h1 (most h2 h3)))
; expect: unsat
(push)
(assert (not (and (<= low (median5 h1 h2 h3 f1 f2)) (<= (median5 h1 h2 h3 f1 f2) high)
                  (<= low (median5 h1 f1 h2 f2 h3)) (<= (median5 h1 f1 h2 f2 h3) high)
                  (<= low (median5 f1 f2 h1 h2 h3)) (<= (median5 f1 f2 h1 h2 h3) high)
                  (<= low (median5 h1 h2 f1 h3 f2)) (<= (median5 h1 h2 f1 h3 f2) high))))
(check-sat)
(pop)

; Two of three that fail put it where they want.
; expect: sat
(push)
(assert (> (median3 h1 f1 f2) (+ h1 1000.0)))
(check-sat)
(pop)
